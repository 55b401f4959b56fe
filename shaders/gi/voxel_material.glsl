// Material lookups of the voxelizers: base colour, alpha, metalness, emission at a point of a triangle, filtered over the
// texels that one voxel covers. Set 1 is the material's.
// A pipeline for geometry that samples none leaves the lookups out: they are most of what there is to compile.
#include "shared/constants.h"
#include "shared/glass.h"
layout(constant_id = CONSTANT_SAMPLES_TEXTURES) const uint SAMPLES_TEXTURES = 1u;
/// MATERIAL_* that a pipeline's materials may have. Code for a texture that none of them has is left out: Mesa's CPU driver
/// would go through it.
layout(constant_id = CONSTANT_MATERIAL_FLAGS) const uint MATERIAL_FLAGS = 0xFFFFFFFFu;
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

/// A texture on a triangle.
struct TexturePlace {
  vec2 corner[3];  ///< coordinates of the triangle's corners
  float level;     ///< of detail, at which a texel is about as large as a voxel
};

/// What all points of a triangle have in common: read once, since Mesa's CPU driver reads for one invocation after the other.
struct MaterialTriangle {
  uvec3 vertex;
  uint flags;
  vec4 color[3];  ///< of the vertices
  vec4 baseColor;
  vec3 emission;
  float metallic, transmission, alphaCutoff;
  TexturePlace baseColorPlace, metallicPlace, emissivePlace, transmissionPlace;  ///< of textures that it samples()
};

bool samples(uint flags, uint flag) {
  return SAMPLES_TEXTURES != 0u && (MATERIAL_FLAGS & flag) != 0u && (flags & flag) != 0u;
}

/// `area`: of the triangle, in what a texel is to be as large as. `size`: of the texture.
TexturePlace texturePlace(SceneArray scenes, uvec3 vertex, uint material, float area, uint slot, ivec2 size) {
  MaterialArray materials = scenes.at[0].materials;
  bool second = ((materials.at[material].uvSets >> slot) & 1u) != 0u;
  Vec2Array uv = scenes.at[0].uv0;
  if (second) uv = scenes.at[0].uv1;
  vec3 rowU = materials.at[material].uvRow[2u * slot];
  vec3 rowV = materials.at[material].uvRow[2u * slot + 1u];
  TexturePlace place;
  vec3 a = vec3(uv.at[vertex.x], 1.0), b = vec3(uv.at[vertex.y], 1.0), c = vec3(uv.at[vertex.z], 1.0);
  place.corner = vec2[3](vec2(dot(rowU, a), dot(rowV, a)), vec2(dot(rowU, b), dot(rowV, b)), vec2(dot(rowU, c), dot(rowV, c)));
  vec2 d = (place.corner[1] - place.corner[0]) * vec2(size);
  vec2 e = (place.corner[2] - place.corner[0]) * vec2(size);
  float texels = 0.5 * abs(d.x * e.y - d.y * e.x) / max(area, 1e-20);  // texels per voxel face
  place.level = texels > 1.0 ? 0.5 * log2(texels) : 0.0;
  return place;
}

vec2 textureCoordinates(TexturePlace place, vec3 weight) {
  return place.corner[0] * weight.x + place.corner[1] * weight.y + place.corner[2] * weight.z;
}

float areaOf(VoxelTriangle t) { return 0.5 * length(t.normal); }

/// `area`: as texturePlace() has it; areaOf() for texels as large as voxels.
MaterialTriangle materialTriangle(SceneArray scenes, uint triangle, float area) {
  MaterialTriangle m;
  UintArray indices = scenes.at[0].indices;
  m.vertex = uvec3(indices.at[3u * triangle], indices.at[3u * triangle + 1u], indices.at[3u * triangle + 2u]);
  Vec4Array colors = scenes.at[0].colors;
  m.color = vec4[3](colors.at[m.vertex.x], colors.at[m.vertex.y], colors.at[m.vertex.z]);
  uint material = scenes.at[0].triangleMaterials.at[triangle];
  MaterialArray materials = scenes.at[0].materials;
  m.flags = materials.at[material].flags;
  m.baseColor = materials.at[material].baseColor;
  m.emission = materials.at[material].emission;
  m.metallic = materials.at[material].metallic;
  m.transmission = materials.at[material].transmission;
  m.alphaCutoff = materials.at[material].alphaCutoff;
  if (samples(m.flags, MATERIAL_BASE_COLOR_TEXTURE))
    m.baseColorPlace =
        texturePlace(scenes, m.vertex, material, area, TEXTURE_BASE_COLOR, textureSize(baseColorTexture, 0));
  if (samples(m.flags, MATERIAL_METALLIC_ROUGHNESS_TEXTURE))
    m.metallicPlace = texturePlace(scenes, m.vertex, material, area, TEXTURE_METALLIC_ROUGHNESS,
                                   textureSize(metallicRoughnessTexture, 0));
  if (samples(m.flags, MATERIAL_EMISSIVE_TEXTURE))
    m.emissivePlace =
        texturePlace(scenes, m.vertex, material, area, TEXTURE_EMISSIVE, textureSize(emissiveTexture, 0));
  if (samples(m.flags, MATERIAL_TRANSMISSION_TEXTURE))
    m.transmissionPlace =
        texturePlace(scenes, m.vertex, material, area, TEXTURE_TRANSMISSION, textureSize(transmissionTexture, 0));
  return m;
}

// At points of a triangle, `weight`: barycentrics().

vec4 vertexColor(MaterialTriangle m, vec3 weight) {
  vec4 first = m.color[0];  // by differences: exact where the three are equal
  return first + (m.color[1] - first) * weight.y + (m.color[2] - first) * weight.z;
}

vec4 baseColorAt(MaterialTriangle m, vec3 weight) {
  vec4 color = m.baseColor * vertexColor(m, weight);
  if (samples(m.flags, MATERIAL_BASE_COLOR_TEXTURE))
    color *= textureLod(baseColorTexture, textureCoordinates(m.baseColorPlace, weight), m.baseColorPlace.level);
  return color;
}

float metallicAt(MaterialTriangle m, vec3 weight) {
  float metallic = m.metallic;
  if (samples(m.flags, MATERIAL_METALLIC_ROUGHNESS_TEXTURE))
    metallic *=
        textureLod(metallicRoughnessTexture, textureCoordinates(m.metallicPlace, weight), m.metallicPlace.level).b;
  return metallic;
}

/// Of a pane: the share of the diffuse part that passes through; alpha; and what passes of each channel.
struct PanePoint {
  float transmitted, alpha;
  vec3 passes;
};
PanePoint panePoint(MaterialTriangle m, vec3 weight) {
  PanePoint pane;
  pane.transmitted = m.transmission;
  if (samples(m.flags, MATERIAL_TRANSMISSION_TEXTURE))
    pane.transmitted *=
        textureLod(transmissionTexture, textureCoordinates(m.transmissionPlace, weight), m.transmissionPlace.level).r;
  bool lambertian = (m.flags & MATERIAL_LAMBERTIAN) != 0u;
  if (!lambertian) pane.transmitted *= 1.0 - clamp(metallicAt(m, weight), 0.0, 1.0);
  vec4 base = baseColorAt(m, weight);
  pane.alpha = paneAlpha(base.a, m.alphaCutoff);
  pane.passes = panePasses(clamp(base.rgb, 0.0, 1.0), pane.alpha, pane.transmitted);
  return pane;
}
bool isPane(MaterialTriangle m) { return PANES && (m.flags & MATERIAL_TRANSMISSIVE) != 0u; }
/// What stands for a pane in its facets is less than alpha says; what it does to light is as much more.
float paneWeight(PanePoint pane) {
  float there = 1.0 - max(pane.passes.r, max(pane.passes.g, pane.passes.b));
  return there > 1e-6 ? pane.alpha / there : 0.0;
}

/// rho of a facet or a piece: clamped to [0, .98], and 0 where it is not a number.
vec3 albedoAt(MaterialTriangle m, vec3 weight, out bool clamped) {
  const float MAX_ALBEDO = 0.98;
  vec3 albedo;
  if (isPane(m)) {
    PanePoint pane = panePoint(m, weight);
    float reflected = max(1.0 - metallicAt(m, weight) - pane.transmitted, 0.0);
    albedo = clamp(baseColorAt(m, weight).rgb, 0.0, 1.0) * (reflected * paneWeight(pane));
  } else {
    albedo = baseColorAt(m, weight).rgb * (1.0 - metallicAt(m, weight));
  }
  clamped = false;
  for (int i = 0; i < 3; ++i) {
    float a = albedo[i];
    albedo[i] = a >= 0.0 ? min(a, MAX_ALBEDO) : 0.0;
    if (!(a >= 0.0 && a <= MAX_ALBEDO)) clamped = true;
  }
  return albedo;
}

vec3 emittedRadianceAt(MaterialTriangle m, vec3 weight) {
  vec3 emission = m.emission;
  if (samples(m.flags, MATERIAL_EMISSIVE_TEXTURE))
    emission *= textureLod(emissiveTexture, textureCoordinates(m.emissivePlace, weight), m.emissivePlace.level).rgb;
  if (isPane(m)) emission *= paneWeight(panePoint(m, weight));
  return emission;
}

/// M of an emitted radiance; finite and not negative, whatever textures hold.
vec3 exitanceOf(vec3 radiance) {
  vec3 exitance = IRAD_PI * radiance;
  for (int i = 0; i < 3; ++i) exitance[i] = exitance[i] > 0.0 ? min(exitance[i], 3.0e38) : 0.0;
  return exitance;
}

/// Whether an alpha mask, which the material has, cuts away what is there.
bool cutAway(MaterialTriangle m, vec3 weight) {
  return SAMPLES_TEXTURES != 0u && baseColorAt(m, weight).a < m.alphaCutoff;
}

/// Whether the material's alpha mask, if it has one, cuts the triangle away at `point`.
bool masked(SceneArray scenes, VoxelTriangle t, uint triangle, uint flags, vec3 point) {
  return SAMPLES_TEXTURES != 0u && (flags & MATERIAL_ALPHA_MASK) != 0u &&
         cutAway(materialTriangle(scenes, triangle, areaOf(t)), barycentrics(t, point));
}
