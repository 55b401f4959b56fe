// "RE Forward": surface and direct light at a visible point, and what a later pass needs to look indirect light up;
// with IRAD_VOLUME the thesis's lookup itself. For the fragment stage (forward/forward.frag) and for the kernel
// (forward/resolve.comp).
#define IRAD_LIGHT_CONSTANTS FORWARD_LIGHTS
#define IRAD_TEXTURED TEXTURED
#include "shared/passes.h"
layout(constant_id = FORWARD_TEXTURED) const bool TEXTURED = true;
layout(constant_id = FORWARD_NORMAL_MAP) const bool NORMAL_MAP = true;
layout(constant_id = FORWARD_EMISSION) const bool EMISSION = true;
layout(constant_id = FORWARD_HIGHLIGHTS) const bool HIGHLIGHTS = true;
layout(constant_id = FORWARD_F0) const bool F0 = true;
layout(constant_id = FORWARD_INDIRECT) const bool INDIRECT = true;
layout(constant_id = FORWARD_GLASS) const bool GLASS = true;
layout(constant_id = FORWARD_TINTED) const bool TINTED = true;
layout(constant_id = FORWARD_PCF) const uint PCF = 3u;
layout(constant_id = FORWARD_MANY_LIGHTS) const bool MANY_LIGHTS = true;

#include "forward/material.glsl"
#include "forward/shadow.glsl"
#include "shared/ggx.h"
#ifndef IRAD_VOLUME
#include "shared/normal_maps.h"
#endif

layout(push_constant, scalar) uniform PushBlock {
  ForwardPush push;
};
layout(set = 0, binding = 2, scalar) uniform LightsBlock {
  GpuLight lights[UNIFORM_LIGHTS];
};
#ifdef IRAD_VOLUME
layout(set = 0, binding = 3) uniform sampler3D indirectVolume;
#define SHADE_BINDINGS 4
#include "thesis/volume_lookup.glsl"
#else
#define SHADE_BINDINGS 3
#endif

/// What the triangle says at the point, interpolated between its corners (forward/forward.vert).
struct Interpolants {
  vec3 local;
  vec3 normal;
  vec4 tangent;
  vec4 uv;
  vec4 tint;
  vec3 faceNormal;  ///< of the triangle, not unit
  vec3 towardsEye;  ///< not unit
  uint triangle;
};

/// Per target (renderer/targets.h); what the constants leave out is not set.
struct Shaded {
  vec4 normal, geometric, albedo, f0, direct, highlight;
#ifdef IRAD_VOLUME
  vec4 indirect;
#else
  vec4 indirect;  ///< where indirect light is looked up, local space, w = 1
  vec4 lookup;    ///< x: the share of it that bumps leave; w: seenAs(triangle)
#endif
};

/// The triangle's own normal, towards the viewer; a triangle without area takes the vertices'.
vec3 orientedFace(Interpolants v, vec3 view) {
  precise vec3 n = dot(v.faceNormal, v.faceNormal) > 0.0 ? preciseNormalize(v.faceNormal) : normalize(v.normal);
  return dot(n, view) < 0.0 ? -n : n;
}

bool hasNormalMap(GpuMaterial m) { return TEXTURED && NORMAL_MAP && (m.flags & MATERIAL_NORMAL_TEXTURE) != 0u; }

vec3 mappedNormal(GpuMaterial m, Interpolants v, vec3 n) {
  if (!hasNormalMap(m)) return n;
  vec3 t = v.tangent.xyz - n * dot(n, v.tangent.xyz);
  float l2 = dot(t, t);
  if (!(l2 > 0.0)) return n;
  t *= inversesqrt(l2);
  vec3 s = IRAD_TEXEL(normalTexture, m, TEXTURE_NORMAL, v.uv).xyz * 2.0 - 1.0;
  s.xy *= m.normalScale;
  return normalize(t * s.x + cross(n, t) * (v.tangent.w * s.y) + n * s.z);
}

#ifndef IRAD_VOLUME
/// The share of an even sky that bumps leave: the mean of four points of the pixel, by the map's finest level, since
/// what the mean of normals leaves is not the mean of what they leave.
float keptByBumps(GpuMaterial m, Interpolants v) {
  vec2 at = textureUv(m, TEXTURE_NORMAL, v.uv);
  vec2 right = uvDifference(m, TEXTURE_NORMAL, uvDx), below = uvDifference(m, TEXTURE_NORMAL, uvDy);
  float sum = 0.0;
  for (uint k = 0u; k < 4u; ++k) {
    // One point in each quarter, no two in a row or column.
    vec2 off = (vec2(float(k), float((2u * k + 1u) % 5u)) - 1.5) * 0.25;
    vec3 s = textureLod(normalTexture, at + right * off.x + below * off.y, 0.0).xyz;
    sum += keptOfEvenSky(tangentCosine(s, m.normalScale));
  }
  return 0.25 * sum;
}
#endif

Shaded shade(Interpolants v) {
  GpuMaterial m;  // members that only textures need stay in memory
  if (TEXTURED || TINTED) m = push.materials.at[push.material];
  m.baseColor = push.baseColor;
  m.emission = push.emission;
  m.metallic = push.metallic;
  m.roughness = push.roughness;
  m.flags = push.flags;

  // Surface frame: the triangle's normal, the vertices' (smooth), the normal map's; all on the viewer's side.
  vec3 view = normalize(v.towardsEye);
  vec3 face = orientedFace(v, view);
  vec3 smooth_ = normalize(v.normal);
#ifdef IRAD_VOLUME
  if (dot(smooth_, face) < 0.0) smooth_ = -smooth_;
  vec3 n = mappedNormal(m, v, smooth_);
  vec3 lookup = dot(smooth_, face) > 0.3 ? smooth_ : face;
#else
  // On backs all of the mapped normal is turned (glTF 2.0, section 3.9.6): bumps are dents from behind.
  vec3 n = mappedNormal(m, v, smooth_);
  if (dot(smooth_, face) < 0.0) {
    smooth_ = -smooth_;
    n = -n;
  }
  bool mapped = hasNormalMap(m);
  precise float smoothMapped = 1.0;
  if (mapped) smoothMapped = preciseDot(smooth_, n);
#endif

  // Material: metallic-roughness, glTF 2.0 section 3.9.2.
  vec4 base = clamp(materialBaseColor(m, v.uv, v.tint), 0.0, 1.0);
  float metallic = m.metallic;
  float roughness = m.roughness;
  if (TEXTURED && (m.flags & MATERIAL_METALLIC_ROUGHNESS_TEXTURE) != 0u) {
    vec4 mr = IRAD_TEXEL(metallicRoughnessTexture, m, TEXTURE_METALLIC_ROUGHNESS, v.uv);
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
    occlusion += m.occlusionStrength * (IRAD_TEXEL(occlusionTexture, m, TEXTURE_OCCLUSION, v.uv).r - 1.0);
  vec3 emission = EMISSION ? m.emission : vec3(0.0);
  if (EMISSION && TEXTURED && (m.flags & MATERIAL_EMISSIVE_TEXTURE) != 0u)
    emission *= IRAD_TEXEL(emissiveTexture, m, TEXTURE_EMISSIVE, v.uv).rgb;

  // Direct light: irradiance for the diffuse part, outgoing radiance for the lobe (docs/method.md 1: D).
  float nv = max(dot(n, view), 1e-3);
  float alpha = max(roughness * roughness, GGX_LEAST_ALPHA);
  precise vec3 direct = vec3(0.0);
  precise vec3 highlight = vec3(0.0);
  LightArray manyLights;
  if (MANY_LIGHTS) manyLights = push.scene.at[0].lights;
  for (uint i = 0u; anyLight() && i < push.lightCount; ++i) {
    GpuLight light = lights[MANY_LIGHTS ? 0u : i];
    if (MANY_LIGHTS) light = manyLights.at[i];
    vec3 l = lightDirection(light, v.local);
    float nl = preciseDot(n, l);
#ifndef IRAD_VOLUME
    // A light behind the face adds nothing, whatever the shading normal says.
    if (preciseDot(face, l) <= 0.0) continue;
#endif
    vec3 e = nl > 0.0 ? lightIntensity(light, v.local) * nl : vec3(0.0);
    if (max(e.r, max(e.g, e.b)) <= 0.0) continue;
    // The surface is known exactly here: half of the setting's lift covers a gathered block of a flat map. (The gather
    // of direct light, gi/gather.comp, which knows its planes less well, takes the whole lift.)
    float bias = hasCubeMap(light) ? push.shadowBias : 0.5 * push.shadowBias;
    if (TINTED) {
      // A map for each channel.
      int layer = light.shadowLayer;
      vec3 share = vec3(1.0);
      for (int c = 0; c < 3 && layer >= 0; ++c) {
        light.shadowLayer = layer + c;
        share[c] = shadowVisibility(light, v.local, face, bias, PCF);
      }
      e *= share;
    } else {
      e *= shadowVisibility(light, v.local, face, bias, PCF);
    }
    vec3 diffuse = e;
#ifndef IRAD_VOLUME
    // As in Cycles, of the diffuse part alone: the lobe's microfacets shadow each other by a law of their own.
    if (mapped) diffuse *= pastBumps(smoothMapped, preciseDot(smooth_, l), nl);
#endif
    direct += diffuse;
    if (!HIGHLIGHTS || lambertian || push.specularDirect == 0u) continue;
    vec3 h = normalize(l + view);
    vec3 nxh = cross(n, h);
    highlight += e * fresnelSchlick(f0, max(dot(view, h), 0.0)) *
                 (ggxDistribution(min(dot(nxh, nxh), 1.0), alpha) * ggxVisibility(nl, nv, alpha));
  }

  Shaded o;
  o.normal = vec4(n, roughness);
  o.geometric = vec4(face, metallic);
  if (GLASS && (m.flags & MATERIAL_BLEND) != 0u) o.geometric.w = packCover(metallic, base.a);
  o.direct = vec4(direct, 1.0);
  if (TINTED && (m.flags & MATERIAL_TRANSMISSIVE) != 0u) {
    float cover = paneAlpha(base.a, m.alphaCutoff), transmitted = materialTransmitted(m, v.uv);
    o.geometric.w = packCover(metallic, cover);
    o.direct.w = uintBitsToFloat(packPasses(panePasses(base.rgb, cover, transmitted)) + 0x3F800000u);
    // albedo, base colour x (1 - metallic), less what passes
    albedo -= base.rgb * transmitted;
  } else if (TINTED) {
    vec3 passes = vec3(1.0 - coverOf(o.geometric.w));
    o.direct.w = uintBitsToFloat(packPasses(passes) + 0x3F800000u);
  }
  o.albedo = vec4(albedo, occlusion);
  if (F0) o.f0 = vec4(f0, lambertian ? 0.0 : 1.0);
  if (HIGHLIGHTS || EMISSION) o.highlight = vec4(highlight + emission, dot(emission, vec3(0.2126, 0.7152, 0.0722)));
  if (!INDIRECT) return o;
#ifdef IRAD_VOLUME
  Grid grid = push.grid.at[0];
  vec3 p = (v.local - grid.origin) * grid.inverseEdge;
  o.indirect = vec4(volumeIndirect(grid, push.sampling, p, lookup), 1.0);
#else
  o.indirect = vec4(v.local, 1.0);
  o.lookup = vec4(mapped ? keptByBumps(m, v) : 1.0, 0.0, 0.0, seenAs(v.triangle));
#endif
  return o;
}
