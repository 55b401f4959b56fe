// The material's textures (set 1) and what they say at a point: shared by the depth and forward passes.
#ifndef IRAD_FORWARD_MATERIAL_GLSL
#define IRAD_FORWARD_MATERIAL_GLSL
#include "shared/scene_gpu.h"

#ifndef IRAD_TEXTURED
#define IRAD_TEXTURED true
#endif
layout(set = 1, binding = 0) uniform sampler2D baseColorTexture;
layout(set = 1, binding = 1) uniform sampler2D metallicRoughnessTexture;
layout(set = 1, binding = 2) uniform sampler2D normalTexture;
layout(set = 1, binding = 3) uniform sampler2D occlusionTexture;
layout(set = 1, binding = 4) uniform sampler2D emissiveTexture;

/// Texture coordinates of texture `i`: uv set and KHR_texture_transform. `uv` holds both sets.
vec2 textureUv(GpuMaterial m, uint i, vec4 uv) {
  vec3 p = vec3((m.uvSets & (1u << i)) != 0u ? uv.zw : uv.xy, 1.0);
  return vec2(dot(m.uvRow[2u * i], p), dot(m.uvRow[2u * i + 1u], p));
}

/// Differences of `uv` to the pixels on the right and below. Kernels have no derivatives; and in fragments a driver
/// would also derive textureUv's result from pixels beside the triangle, for which lavapipe reads zeros from memory.
vec4 uvDx, uvDy;
vec2 uvDifference(GpuMaterial m, uint i, vec4 d) {
  vec2 set = (m.uvSets & (1u << i)) != 0u ? d.zw : d.xy;
  return vec2(dot(m.uvRow[2u * i].xy, set), dot(m.uvRow[2u * i + 1u].xy, set));
}
#define IRAD_TEXEL(map, m, i, uv) \
  textureGrad(map, textureUv(m, i, uv), uvDifference(m, i, uvDx), uvDifference(m, i, uvDy))

/// Base colour (linear) and alpha; `tint` is the vertex colour.
vec4 materialBaseColor(GpuMaterial m, vec4 uv, vec4 tint) {
  vec4 c = m.baseColor * tint;
  if (IRAD_TEXTURED && (m.flags & MATERIAL_BASE_COLOR_TEXTURE) != 0u)
    c *= IRAD_TEXEL(baseColorTexture, m, TEXTURE_BASE_COLOR, uv);
  return c;
}

/// `threshold`: a blended surface is there where its alpha is above it.
bool materialCutOut(GpuMaterial m, float alpha, float threshold) {
  if ((m.flags & MATERIAL_ALPHA_MASK) == 0u) return false;
  return (m.flags & MATERIAL_BLEND) != 0u ? alpha <= threshold : alpha < m.alphaCutoff;
}

#endif
