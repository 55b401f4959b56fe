// "RE Forward", fragment stage: surface and direct light, and with IRAD_VOLUME the thesis's indirect lookup; without,
// what forward/indirect.comp needs for the lookup in the facets. Written once per visible pixel (the depth prepass and
// EQUAL see to it); renderer/forward.h says what each target holds.
#define IRAD_LIGHT_CONSTANTS FORWARD_LIGHTS
#define IRAD_TEXTURED TEXTURED
#include "shared/passes.h"
layout(constant_id = FORWARD_TEXTURED) const bool TEXTURED = true;
layout(constant_id = FORWARD_NORMAL_MAP) const bool NORMAL_MAP = true;
layout(constant_id = FORWARD_EMISSION) const bool EMISSION = true;
layout(constant_id = FORWARD_HIGHLIGHTS) const bool HIGHLIGHTS = true;
layout(constant_id = FORWARD_F0) const bool F0 = true;
layout(constant_id = FORWARD_INDIRECT) const bool INDIRECT = true;
layout(constant_id = FORWARD_PCF) const uint PCF = 3u;
layout(constant_id = FORWARD_MANY_LIGHTS) const bool MANY_LIGHTS = true;

#include "forward/indirect.glsl"
#include "forward/material.glsl"
#include "forward/shadow.glsl"
#include "shared/ggx.h"

layout(push_constant, scalar) uniform PushBlock {
  ForwardPush push;
};
layout(set = 0, binding = IRAD_LIGHTS_BINDING, scalar) uniform LightsBlock {
  GpuLight lights[UNIFORM_LIGHTS];
};
layout(location = 0) in vec3 local;
layout(location = 1) in vec3 normal;
layout(location = 2) in vec4 tangent;
layout(location = 3) in vec4 uv;
layout(location = 4) in vec4 tint;
layout(location = 5) flat in vec3 faceNormal;
layout(location = 6) in vec3 towardsEye;  ///< not unit

layout(location = 0) out vec4 outNormal;
layout(location = 1) out vec4 outGeometric;
layout(location = 2) out vec4 outAlbedo;
layout(location = 3) out vec4 outF0;
layout(location = 4) out vec4 outDirect;
layout(location = 5) out vec4 outHighlight;
layout(location = 6) out vec4 outIndirect;
#ifndef IRAD_VOLUME
layout(location = 7) out vec4 outLookup;
#endif

/// The triangle's own normal, towards the viewer. One without area takes the vertices'.
vec3 orientedFace(vec3 view) {
  precise vec3 n = dot(faceNormal, faceNormal) > 0.0 ? preciseNormalize(faceNormal) : normalize(normal);
  return dot(n, view) < 0.0 ? -n : n;
}

vec3 mappedNormal(GpuMaterial m, vec3 n) {
  if (!TEXTURED || !NORMAL_MAP || (m.flags & MATERIAL_NORMAL_TEXTURE) == 0u) return n;
  vec3 t = tangent.xyz - n * dot(n, tangent.xyz);
  float l2 = dot(t, t);
  if (!(l2 > 0.0)) return n;
  t *= inversesqrt(l2);
  vec3 s = IRAD_TEXEL(normalTexture, m, TEXTURE_NORMAL, uv).xyz * 2.0 - 1.0;
  s.xy *= m.normalScale;
  return normalize(t * s.x + cross(n, t) * (tangent.w * s.y) + n * s.z);
}

void main() {
  GpuMaterial m;  // what only textures need stays in memory
  if (TEXTURED) m = push.materials.at[push.material];
  m.baseColor = push.baseColor;
  m.emission = push.emission;
  m.metallic = push.metallic;
  m.roughness = push.roughness;
  m.flags = push.flags;

  // Surface frame: the triangle's normal, the vertices' (smooth), the normal map's; all on the viewer's side.
  vec3 view = normalize(towardsEye);
  vec3 face = orientedFace(view);
  vec3 smooth_ = normalize(normal);
  if (dot(smooth_, face) < 0.0) smooth_ = -smooth_;
  vec3 n = mappedNormal(m, smooth_);
  vec3 lookup = dot(smooth_, face) > 0.3 ? smooth_ : face;

  // Material: metallic-roughness, glTF 2.0 section 3.9.2.
  vec4 base = clamp(materialBaseColor(m, uv, tint), 0.0, 1.0);
  float metallic = m.metallic;
  float roughness = m.roughness;
  if (TEXTURED && (m.flags & MATERIAL_METALLIC_ROUGHNESS_TEXTURE) != 0u) {
    vec4 mr = IRAD_TEXEL(metallicRoughnessTexture, m, TEXTURE_METALLIC_ROUGHNESS, uv);
    metallic *= mr.b;
    roughness *= mr.g;
  }
  metallic = clamp(metallic, 0.0, 1.0);
  roughness = clamp(roughness, 0.0, 1.0);
  bool lambertian = (m.flags & MATERIAL_LAMBERTIAN) != 0u;
  vec3 albedo = lambertian ? base.rgb : base.rgb * (1.0 - metallic);
  vec3 f0 = lambertian ? vec3(0.0) : mix(vec3(0.04), base.rgb, metallic);
  float occlusion = 1.0;
  if (TEXTURED && (m.flags & MATERIAL_OCCLUSION_TEXTURE) != 0u)
    occlusion += m.occlusionStrength * (IRAD_TEXEL(occlusionTexture, m, TEXTURE_OCCLUSION, uv).r - 1.0);
  vec3 emission = EMISSION ? m.emission : vec3(0.0);
  if (EMISSION && TEXTURED && (m.flags & MATERIAL_EMISSIVE_TEXTURE) != 0u)
    emission *= IRAD_TEXEL(emissiveTexture, m, TEXTURE_EMISSIVE, uv).rgb;

  // Direct light: irradiance for the diffuse part, outgoing radiance for the lobe (METHOD section 1: D).
  float nv = max(dot(n, view), 1e-3);
  float alpha = max(roughness * roughness, GGX_LEAST_ALPHA);
  precise vec3 direct = vec3(0.0);
  precise vec3 highlight = vec3(0.0);
  for (uint i = 0u; anyLight() && i < push.lightCount; ++i) {
    GpuLight light = lights[MANY_LIGHTS ? 0u : i];
    if (MANY_LIGHTS) light = push.lights.at[i];
    vec3 l = lightDirection(light, local);
    float nl = preciseDot(n, l);
    vec3 e = nl > 0.0 ? lightIntensity(light, local) * nl : vec3(0.0);
    if (max(e.r, max(e.g, e.b)) <= 0.0) continue;
    // The surface is known exactly here: half of the setting's lift covers a gathered block of a flat map. (The facet
    // gather knows its planes less well and takes all of it.)
    float bias = hasCubeMap(light) ? push.shadowBias : 0.5 * push.shadowBias;
    e *= shadowVisibility(light, local, face, bias, PCF);
    direct += e;
    if (!HIGHLIGHTS || lambertian || push.specularDirect == 0u) continue;
    vec3 h = normalize(l + view);
    highlight += e * fresnelSchlick(f0, max(dot(view, h), 0.0)) *
                 (ggxDistribution(max(dot(n, h), 0.0), alpha) * ggxVisibility(nl, nv, alpha));
  }

  outNormal = vec4(n, roughness);
  outGeometric = vec4(face, metallic);
  outAlbedo = vec4(albedo, occlusion);
  if (F0) outF0 = vec4(f0, lambertian ? 0.0 : 1.0);
  outDirect = vec4(direct, 1.0);
  if (HIGHLIGHTS || EMISSION) outHighlight = vec4(highlight + emission, dot(emission, vec3(0.2126, 0.7152, 0.0722)));
  if (!INDIRECT) return;
#ifdef IRAD_VOLUME
  Grid grid = push.grid.at[0];
  vec3 p = (local - grid.origin) * grid.inverseEdge;
  outIndirect = vec4(volumeIndirect(grid, push.sampling, p, lookup), 1.0);
#else
  outIndirect = vec4(local, 1.0);
  outLookup = vec4(lookup, 1.0);
#endif
}
