// Push constants of the passes that make pictures (renderer/forward.cpp).
#ifndef IRAD_SHARED_PASSES_H
#define IRAD_SHARED_PASSES_H
#include "shared/gi_params.h"
#include "shared/grid.h"
#include "shared/scene_gpu.h"
IRAD_BEGIN

struct Projection {
  mat4 matrix;
};
IRAD_ARRAY(ProjectionArray, Projection, 16)

/// "RE Shadow" and "RE Depth".
struct DepthPush {
  SceneArray scene;
  ProjectionArray projection;  ///< local position -> clip; a GpuCamera starts with it
  uint material;
  /// 1 + a channel: blended surfaces are there in the share of the texels that they keep off of it, alpha where they have
  /// no tint; 0: wherever alpha is above 0.
  uint screens;
};

/// Specialization constants of "RE Forward" (forward/shade.glsl, forward/resolve.comp). The effects leave out what they
/// are false for.
IRAD_CONST uint FORWARD_LIGHTS = 64u;                                 ///< LIGHT_CONSTANTS of them
IRAD_CONST uint FORWARD_TEXTURED = FORWARD_LIGHTS + LIGHT_CONSTANTS;  ///< effect: a material of the pass has a texture
IRAD_CONST uint FORWARD_NORMAL_MAP = FORWARD_TEXTURED + 1u;           ///< effect: ... a normal map
IRAD_CONST uint FORWARD_EMISSION = FORWARD_TEXTURED + 2u;             ///< effect
IRAD_CONST uint FORWARD_HIGHLIGHTS = FORWARD_TEXTURED + 3u;           ///< effect: the lights' specular lobe
IRAD_CONST uint FORWARD_F0 = FORWARD_TEXTURED + 4u;                   ///< effect: reflections are traced
IRAD_CONST uint FORWARD_INDIRECT = FORWARD_TEXTURED + 5u;             ///< effect: looked up, here or later
IRAD_CONST uint FORWARD_PCF = FORWARD_TEXTURED + 6u;
IRAD_CONST uint FORWARD_MANY_LIGHTS = FORWARD_TEXTURED + 7u;  ///< more than UNIFORM_LIGHTS
IRAD_CONST uint FORWARD_GLASS = FORWARD_TEXTURED + 8u;        ///< effect: blended surfaces
IRAD_CONST uint FORWARD_TINTED = FORWARD_TEXTURED + 9u;       ///< effect: panes that tint what passes
IRAD_CONST uint FORWARD_TARGETS = FORWARD_TEXTURED + 10u;      ///< kernels: those of TARGETS_ALL that are there

/// Targets that are there only where a picture is composed from them: bits of a specialization constant of the shaders
/// that read or write them. An absent term is 0.
IRAD_CONST uint TARGET_F0 = 1u;
IRAD_CONST uint TARGET_HIGHLIGHT = 2u;
IRAD_CONST uint TARGET_INDIRECT = 4u;
IRAD_CONST uint TARGET_EMITTED = 8u;
IRAD_CONST uint TARGET_SPECULAR = 16u;
IRAD_CONST uint TARGETS_ALL = 31u;

/// The w of Targets::geometric: metallic or, of a blended surface, less than 0: its alpha, and whether it is a metal.
IRAD_FN float packCover(float metallic, float alpha) {
  return -max(alpha, 1e-4f) - (metallic >= 0.5f ? 2.0f : 0.0f);
}
IRAD_FN float coverOf(float packed) { return packed >= 0.0f ? 1.0f : (packed < -1.5f ? -packed - 2.0f : -packed); }
IRAD_FN float metallicOf(float packed) { return packed >= 0.0f ? packed : (packed < -1.5f ? 1.0f : 0.0f); }

/// forward/add_layer.comp.
struct LayerPush {
  uint first;  ///< 1: of the picture
  uint last;
};

/// Lights that "RE Forward" reads through a uniform block; with more of them all are read by address.
IRAD_CONST uint UNIFORM_LIGHTS = 64u;

/// Kernels: the visible pixels of one material, which forward/resolve.comp shades.
struct PixelList {
  uvec3 groups;  ///< dispatch arguments
  uint count;
  uint end;  ///< of the list in the array of listed pixels (x | y << 16, triangle), which keep no particular order
};
IRAD_ARRAY(PixelListArray, PixelList, 4)
IRAD_CONST uint RESOLVE_GROUP = 64u;   ///< pixels per workgroup
IRAD_CONST uint RESOLVE_ROW = 32768u;  ///< workgroups in x at most

/// forward/list_pixels.comp and forward/place_lists.comp.
struct PixelListPush {
  SceneArray scene;
  Uvec2Array visible;
  PixelListArray lists;  ///< per material, and after them one whose `end` is that of all
  Uvec2Array listed;
  uvec2 size;
  uint materials;
};

/// The triangle that a pixel sees, beside what else its lookup of indirect light needs, as a float that no step on the
/// way takes for a denormal or for no number.
#ifndef __cplusplus
float seenAs(uint triangle) { return uintBitsToFloat(triangle + 0x3F800000u); }
uint seenTriangle(float seen) { return floatBitsToUint(seen) - 0x3F800000u; }
#endif

/// "RE Forward", shading. What untextured pixels need of the material travels along: as constants it is read once,
/// not per lane.
struct ForwardPush {
  SceneArray scene;
  CameraArray camera;
  MaterialArray materials;
  PixelListArray lists;  ///< kernels: per material
  Uvec2Array listed;     ///< kernels: pixels and triangles, list after list
  GridArray grid;        ///< of the volume that indirect light is looked up in (IRAD_VOLUME)
  SampleParams sampling;  ///< of that lookup
  vec4 baseColor;
  vec3 emission;
  float metallic, roughness;
  uint flags;
  uint material;
  uint lightCount;
  float shadowBias;
  uint specularDirect;
};

IRAD_END
#endif
