// The material's textures (set 1) and what they say at a point: shared by the depth and forward passes.
#ifndef IRAD_FORWARD_MATERIAL_GLSL
#define IRAD_FORWARD_MATERIAL_GLSL
#include "shared/glass.h"
#include "shared/scene_gpu.h"

#ifndef IRAD_TEXTURED
#define IRAD_TEXTURED true
#endif
layout(set = 1, binding = 0) uniform sampler2D baseColorTexture;
layout(set = 1, binding = 1) uniform sampler2D metallicRoughnessTexture;
layout(set = 1, binding = 2) uniform sampler2D normalTexture;
layout(set = 1, binding = 3) uniform sampler2D occlusionTexture;
layout(set = 1, binding = 4) uniform sampler2D emissiveTexture;
layout(set = 1, binding = 5) uniform sampler2D transmissionTexture;

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

/// The share of the diffuse part that passes through.
float materialTransmitted(GpuMaterial m, vec4 uv) {
  float transmitted = m.transmission, metallic = m.metallic;
  if (IRAD_TEXTURED && (m.flags & MATERIAL_TRANSMISSION_TEXTURE) != 0u)
    transmitted *= IRAD_TEXEL(transmissionTexture, m, TEXTURE_TRANSMISSION, uv).r;
  if (IRAD_TEXTURED && (m.flags & MATERIAL_METALLIC_ROUGHNESS_TEXTURE) != 0u)
    metallic *= IRAD_TEXEL(metallicRoughnessTexture, m, TEXTURE_METALLIC_ROUGHNESS, uv).b;
  return (m.flags & MATERIAL_LAMBERTIAN) != 0u ? transmitted : transmitted * (1.0 - clamp(metallic, 0.0, 1.0));
}

/// What a surface keeps off what is behind it, of a channel; of no channel (PANE_WHOLE) whether it is there at all.
const uint PANE_WHOLE = 3u;
float materialCover(GpuMaterial m, vec4 uv, vec4 base, uint channel) {
  if ((m.flags & MATERIAL_TRANSMISSIVE) == 0u) return base.a;
  float alpha = paneAlpha(base.a, m.alphaCutoff);
  if (channel == PANE_WHOLE || alpha == 0.0) return alpha;
  return 1.0 - panePasses(clamp(base.rgb, 0.0, 1.0), alpha, materialTransmitted(m, uv))[channel];
}

/// `threshold`: a blended surface is there where its alpha is above it.
bool materialCutOut(GpuMaterial m, float alpha, float threshold) {
  if ((m.flags & MATERIAL_ALPHA_MASK) == 0u) return false;
  return (m.flags & MATERIAL_BLEND) != 0u ? alpha <= threshold : alpha < m.alphaCutoff;
}

#endif
