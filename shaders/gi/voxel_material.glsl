// Material lookups of the voxelizers: base colour, alpha, metalness, emission at a point of a triangle, filtered over the
// texels that one voxel covers. Set 1 is the material's.
// A pipeline for geometry that samples none leaves the lookups out: they are most of what there is to compile.
#include "shared/constants.h"
#include "shared/glass.h"
layout(constant_id = CONSTANT_SAMPLES_TEXTURES) const uint SAMPLES_TEXTURES = 1u;
/// There are panes: without, there is no code for them, which Mesa's CPU driver would go through at every point.
layout(constant_id = CONSTANT_TINTED) const bool PANES = true;
layout(set = 1, binding = 0) uniform sampler2D baseColorTexture;
layout(set = 1, binding = 1) uniform sampler2D metallicRoughnessTexture;
layout(set = 1, binding = 4) uniform sampler2D emissiveTexture;
layout(set = 1, binding = 5) uniform sampler2D transmissionTexture;

/// Weights of the three vertices at `point` (voxel units); clamped into the triangle against rounding.
vec3 barycentrics(VoxelTriangle t, vec3 point) {
  float scale = 1.0 / dot(t.normal, t.normal);
  vec3 d = point - t.v[0];
  float b1 = dot(cross(d, t.v[2] - t.v[0]), t.normal) * scale;
  float b2 = dot(cross(t.v[1] - t.v[0], d), t.normal) * scale;
  vec3 b = clamp(vec3(1.0 - b1 - b2, b1, b2), vec3(0.0), vec3(1.0));
  return b / (b.x + b.y + b.z);
}

struct MaterialPoint {
  uvec3 vertex;  ///< the triangle's vertices
  vec3 weight;   ///< their weights
  float area;    ///< the triangle's, in voxel faces
  uint material;
};

MaterialPoint materialPoint(SceneArray scenes, VoxelTriangle t, uint triangle, vec3 point) {
  MaterialPoint p;
  UintArray indices = scenes.at[0].indices;
  p.vertex = uvec3(indices.at[3u * triangle], indices.at[3u * triangle + 1u], indices.at[3u * triangle + 2u]);
  p.weight = barycentrics(t, point);
  p.area = 0.5 * length(t.normal);
  p.material = scenes.at[0].triangleMaterials.at[triangle];
  return p;
}

/// Texture coordinates of texture `slot` and the level of detail at which a texel is about as large as a voxel.
vec3 textureCoordinates(SceneArray scenes, MaterialPoint p, uint slot, ivec2 size) {
  MaterialArray materials = scenes.at[0].materials;
  bool second = ((materials.at[p.material].uvSets >> slot) & 1u) != 0u;
  Vec2Array uv = scenes.at[0].uv0;
  if (second) uv = scenes.at[0].uv1;
  vec3 rowU = materials.at[p.material].uvRow[2u * slot];
  vec3 rowV = materials.at[p.material].uvRow[2u * slot + 1u];
  vec2 corner[3];
  for (int i = 0; i < 3; ++i) {
    vec3 h = vec3(uv.at[p.vertex[i]], 1.0);
    corner[i] = vec2(dot(rowU, h), dot(rowV, h));
  }
  vec2 at = corner[0] * p.weight.x + corner[1] * p.weight.y + corner[2] * p.weight.z;
  vec2 d = (corner[1] - corner[0]) * vec2(size);
  vec2 e = (corner[2] - corner[0]) * vec2(size);
  float texels = 0.5 * abs(d.x * e.y - d.y * e.x) / max(p.area, 1e-20);  // texels per voxel face
  return vec3(at, texels > 1.0 ? 0.5 * log2(texels) : 0.0);
}

bool samples(SceneArray scenes, MaterialPoint p, uint flag) {
  return SAMPLES_TEXTURES != 0u && (scenes.at[0].materials.at[p.material].flags & flag) != 0u;
}

vec4 vertexColor(SceneArray scenes, MaterialPoint p) {
  Vec4Array colors = scenes.at[0].colors;
  vec4 first = colors.at[p.vertex.x];  // by differences: exact where the three are equal
  return first + (colors.at[p.vertex.y] - first) * p.weight.y + (colors.at[p.vertex.z] - first) * p.weight.z;
}

vec4 baseColorAt(SceneArray scenes, MaterialPoint p) {
  vec4 color = scenes.at[0].materials.at[p.material].baseColor * vertexColor(scenes, p);
  if (samples(scenes, p, MATERIAL_BASE_COLOR_TEXTURE)) {
    vec3 uvl = textureCoordinates(scenes, p, TEXTURE_BASE_COLOR, textureSize(baseColorTexture, 0));
    color *= textureLod(baseColorTexture, uvl.xy, uvl.z);
  }
  return color;
}

float metallicAt(SceneArray scenes, MaterialPoint p) {
  float metallic = scenes.at[0].materials.at[p.material].metallic;
  if (samples(scenes, p, MATERIAL_METALLIC_ROUGHNESS_TEXTURE)) {
    vec3 uvl = textureCoordinates(scenes, p, TEXTURE_METALLIC_ROUGHNESS, textureSize(metallicRoughnessTexture, 0));
    metallic *= textureLod(metallicRoughnessTexture, uvl.xy, uvl.z).b;
  }
  return metallic;
}

/// Of a pane: the share of the diffuse part that passes through; alpha; and what passes of each channel.
struct PanePoint {
  float transmitted, alpha;
  vec3 passes;
};
PanePoint panePoint(SceneArray scenes, MaterialPoint p) {
  PanePoint pane;
  pane.transmitted = scenes.at[0].materials.at[p.material].transmission;
  if (samples(scenes, p, MATERIAL_TRANSMISSION_TEXTURE)) {
    vec3 uvl = textureCoordinates(scenes, p, TEXTURE_TRANSMISSION, textureSize(transmissionTexture, 0));
    pane.transmitted *= textureLod(transmissionTexture, uvl.xy, uvl.z).r;
  }
  bool lambertian = (scenes.at[0].materials.at[p.material].flags & MATERIAL_LAMBERTIAN) != 0u;
  if (!lambertian) pane.transmitted *= 1.0 - clamp(metallicAt(scenes, p), 0.0, 1.0);
  vec4 base = baseColorAt(scenes, p);
  pane.alpha = paneAlpha(base.a, scenes.at[0].materials.at[p.material].alphaCutoff);
  pane.passes = panePasses(clamp(base.rgb, 0.0, 1.0), pane.alpha, pane.transmitted);
  return pane;
}
bool isPane(SceneArray scenes, MaterialPoint p) {
  return PANES && (scenes.at[0].materials.at[p.material].flags & MATERIAL_TRANSMISSIVE) != 0u;
}
/// What stands for a pane in its facets is less than alpha says; what it does to light is as much more.
float paneWeight(PanePoint pane) {
  float there = 1.0 - max(pane.passes.r, max(pane.passes.g, pane.passes.b));
  return there > 1e-6 ? pane.alpha / there : 0.0;
}

/// rho of a facet or a piece: clamped to [0, .98], and 0 where it is not a number.
vec3 albedoAt(SceneArray scenes, MaterialPoint p, out bool clamped) {
  const float MAX_ALBEDO = 0.98;
  vec3 albedo;
  if (isPane(scenes, p)) {
    PanePoint pane = panePoint(scenes, p);
    float reflected = max(1.0 - metallicAt(scenes, p) - pane.transmitted, 0.0);
    albedo = clamp(baseColorAt(scenes, p).rgb, 0.0, 1.0) * (reflected * paneWeight(pane));
  } else {
    albedo = baseColorAt(scenes, p).rgb * (1.0 - metallicAt(scenes, p));
  }
  clamped = false;
  for (int i = 0; i < 3; ++i) {
    float a = albedo[i];
    albedo[i] = a >= 0.0 ? min(a, MAX_ALBEDO) : 0.0;
    if (!(a >= 0.0 && a <= MAX_ALBEDO)) clamped = true;
  }
  return albedo;
}

vec3 emittedRadianceAt(SceneArray scenes, MaterialPoint p) {
  vec3 emission = scenes.at[0].materials.at[p.material].emission;
  if (samples(scenes, p, MATERIAL_EMISSIVE_TEXTURE)) {
    vec3 uvl = textureCoordinates(scenes, p, TEXTURE_EMISSIVE, textureSize(emissiveTexture, 0));
    emission *= textureLod(emissiveTexture, uvl.xy, uvl.z).rgb;
  }
  if (isPane(scenes, p)) emission *= paneWeight(panePoint(scenes, p));
  return emission;
}

/// M of an emitted radiance; finite and not negative, whatever textures hold.
vec3 exitanceOf(vec3 radiance) {
  vec3 exitance = IRAD_PI * radiance;
  for (int i = 0; i < 3; ++i) exitance[i] = exitance[i] > 0.0 ? min(exitance[i], 3.0e38) : 0.0;
  return exitance;
}

/// Alpha of a blended material.
float coverAt(SceneArray scenes, VoxelTriangle t, uint triangle, vec3 point) {
  return baseColorAt(scenes, materialPoint(scenes, t, triangle, point)).a;
}

/// Whether an alpha mask, which the material has, cuts away what is there.
bool cutAway(SceneArray scenes, MaterialPoint p) {
  return SAMPLES_TEXTURES != 0u && baseColorAt(scenes, p).a < scenes.at[0].materials.at[p.material].alphaCutoff;
}

/// Whether the material's alpha mask, if it has one, cuts the triangle away at `point`.
bool masked(SceneArray scenes, VoxelTriangle t, uint triangle, uint flags, vec3 point) {
  return SAMPLES_TEXTURES != 0u && (flags & MATERIAL_ALPHA_MASK) != 0u &&
         cutAway(scenes, materialPoint(scenes, t, triangle, point));
}
