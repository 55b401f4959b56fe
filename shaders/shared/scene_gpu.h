// The scene as shaders see it: vertex arrays by address, materials, lights, camera. Positions are local (relative to
// Scene::origin), fp32.
#ifndef IRAD_SHARED_SCENE_GPU_H
#define IRAD_SHARED_SCENE_GPU_H
#include "shared/enumeration.h"
#include "shared/light_kinds.h"
#include "shared/types.h"
IRAD_BEGIN

/// Flags of GpuMaterial.
IRAD_CONST uint MATERIAL_ALPHA_MASK = 1u;
IRAD_CONST uint MATERIAL_DOUBLE_SIDED = 2u;
IRAD_CONST uint MATERIAL_BASE_COLOR_TEXTURE = 4u;
IRAD_CONST uint MATERIAL_METALLIC_ROUGHNESS_TEXTURE = 8u;
IRAD_CONST uint MATERIAL_NORMAL_TEXTURE = 16u;
IRAD_CONST uint MATERIAL_OCCLUSION_TEXTURE = 32u;
IRAD_CONST uint MATERIAL_EMISSIVE_TEXTURE = 64u;
IRAD_CONST uint MATERIAL_TRANSMISSION_TEXTURE = 128u;
IRAD_CONST uint MATERIAL_BLEND = 256u;       ///< | MATERIAL_ALPHA_MASK: covers the share alpha of what meets it
IRAD_CONST uint MATERIAL_LAMBERTIAN = 512u;  ///< no specular lobe at all (LoadOptions::lambertian)
/// | MATERIAL_BLEND: lets light through in its base colour (shared/glass.h). alphaCutoff is that of its alpha mask, 0 of
/// an opaque one, below 0 where it blends.
IRAD_CONST uint MATERIAL_TRANSMISSIVE = 1024u;

/// Order of the textures in set 1, and how many there are.
IRAD_CONST uint TEXTURE_BASE_COLOR = 0u;
IRAD_CONST uint TEXTURE_METALLIC_ROUGHNESS = 1u;
IRAD_CONST uint TEXTURE_NORMAL = 2u;
IRAD_CONST uint TEXTURE_OCCLUSION = 3u;
IRAD_CONST uint TEXTURE_EMISSIVE = 4u;
IRAD_CONST uint TEXTURE_TRANSMISSION = 5u;
IRAD_CONST uint MATERIAL_TEXTURES = 6u;

struct GpuMaterial {
  vec4 baseColor;  ///< linear
  vec3 emission;   ///< radiance, W/(m^2 sr)
  float metallic;
  float roughness;
  float normalScale;
  float occlusionStrength;
  float alphaCutoff;
  float transmission;
  uint flags;
  uint uvSets;  ///< bit i: texture i uses TEXCOORD_1
  /// Two rows of the 2x3 uv transform per texture: uv'.x = dot(uvRow[2i], vec3(uv, 1)), ...
  vec3 uvRow[2 * MATERIAL_TEXTURES];
};

// How the shadow map of a light without a size is read (docs/method.md 6). hard: one comparison. vsm: variance shadow
// maps (Donnelly and Lauritzen 2006; T 11.5).
// clang-format off
#define IRAD_SHADOW_FILTERS(X, E) \
  X(E, hard, "hard", SHADOW_HARD, 0) \
  X(E, pcf,  "pcf",  SHADOW_PCF,  1) \
  X(E, vsm,  "vsm",  SHADOW_VSM,  2)
IRAD_SHARED_ENUM(ShadowFilter, IRAD_SHADOW_FILTERS)
// clang-format on

struct GpuLight {
  vec3 position;   ///< local
  uint type;       ///< LIGHT_SUN and so on
  vec3 direction;  ///< unit, the way the light shines
  float range;     ///< 0: unlimited
  vec3 intensity;  ///< colour x intensity: lux (sun) or candela
  int shadowLayer; ///< layer in the 2D array, or cube index where lightUsesCube; -1: casts no shadow
  float innerCos, outerCos;
  float size;  ///< 0: none. Of a distant light the tangent of half its angle, of others their radius, m
  float shadowNear, shadowFar;  ///< point and spot: planes of the shadow projection
  float shadowTexel;  ///< world size of one shadow texel (sun), or its tangent at unit distance (spot, point)
  IRAD_AS(ShadowFilter) shadowFilter;
  float bleedReduction;  ///< SHADOW_VSM: bounds up to this share count as dark, [0, 1)
  uint points;           ///< of a light with a size, that are looked at
  mat4 shadowMatrix;  ///< local position -> clip space of the layer (sun, spot)
};

struct GpuCamera {
  mat4 viewProjection;  ///< local position -> clip, depth 1 at znear, 0 at zfar
  mat4 inverseViewProjection;
  vec3 position;  ///< local
  float znear, zfar;
  uint orthographic;
  uvec2 size;  ///< pixels
};

IRAD_ARRAY(MaterialArray, GpuMaterial, 16)
IRAD_ARRAY(LightArray, GpuLight, 16)
IRAD_ARRAY(CameraArray, GpuCamera, 16)

/// One per scene: every pass that reads geometry gets its address.
struct GpuScene {
  Vec3Array positions;
  Vec3Array normals;
  Vec4Array tangents;
  Vec2Array uv0;
  Vec2Array uv1;
  Vec4Array colors;
  UintArray indices;           ///< 3 per triangle
  UintArray triangleMaterials; ///< material of each triangle
  MaterialArray materials;
  LightArray lights;
  uint lightCount;
  uint triangleCount;
};
IRAD_ARRAY(SceneArray, GpuScene, 16)

IRAD_END
#endif
