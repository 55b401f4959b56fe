// The list of kinds of light: files, panels, the effect plan, shadow maps and shaders go by it.
//   X(CONSTANT, number, LightType, Effect, glTF type, name, one, many, shadow map, traits)
// A new kind is one row here, its formula in shaders/forward/light.h, its effect in gi/plan.h, and the text of that
// effect's setting in gi/settings_table.cpp. `name` is that of manifests, sidecars and panels.
#ifndef IRAD_SHARED_LIGHT_KINDS_H
#define IRAD_SHARED_LIGHT_KINDS_H
#include "shared/types.h"
IRAD_BEGIN

// How a light's shadows are drawn.
IRAD_CONST uint LIGHT_MAP_PARALLEL = 0u;  ///< flat, one direction, around the whole scene
IRAD_CONST uint LIGHT_MAP_CUBE = 1u;      ///< six faces
IRAD_CONST uint LIGHT_MAP_CONE = 2u;      ///< flat, in perspective; six faces where the cone is too wide for that

// What a light has: a sum of these.
IRAD_CONST uint LIGHT_DISTANT = 1u;    ///< lux, the same everywhere; its position is that of its handle alone
IRAD_CONST uint LIGHT_DIRECTION = 2u;  ///< it shines one way
IRAD_CONST uint LIGHT_RANGE = 4u;      ///< where it has faded out
IRAD_CONST uint LIGHT_CONE = 8u;       ///< inner and outer angle

// clang-format off
#define IRAD_LIGHT_KINDS(X) \
  X(SUN,   0, Sun,   sun,   "directional", "sun",   "sun",         "suns",         LIGHT_MAP_PARALLEL, LIGHT_DISTANT | LIGHT_DIRECTION) \
  X(POINT, 1, Point, point, "point",       "point", "point light", "point lights", LIGHT_MAP_CUBE,     LIGHT_RANGE) \
  X(SPOT,  2, Spot,  spot,  "spot",        "spot",  "spot light",  "spot lights",  LIGHT_MAP_CONE,     LIGHT_DIRECTION | LIGHT_RANGE | LIGHT_CONE)
// clang-format on

#define IRAD_LIGHT_ONE_MORE(constant, number, id, effect, gltf, name, one, many, map, traits) +1u
IRAD_CONST uint LIGHT_KINDS = 0u IRAD_LIGHT_KINDS(IRAD_LIGHT_ONE_MORE);
#undef IRAD_LIGHT_ONE_MORE

#define IRAD_LIGHT_CONSTANT(constant, number, id, effect, gltf, name, one, many, map, traits) \
  IRAD_CONST uint LIGHT_##constant = uint(number);
IRAD_LIGHT_KINDS(IRAD_LIGHT_CONSTANT)
#undef IRAD_LIGHT_CONSTANT

// Specialization constants of shaders that sum up lights (forward/shadow.glsl), counted from the first that such a
// shader gives them: LIGHT_SUN and so on say which kinds of light shine, these which shadow maps there are. What is
// false has no code.
IRAD_CONST uint LIGHT_FLAT_MAPS = LIGHT_KINDS;
IRAD_CONST uint LIGHT_CUBE_MAPS = LIGHT_KINDS + 1u;
IRAD_CONST uint LIGHT_SIZES = LIGHT_KINDS + 2u;      ///< a light has a size
IRAD_CONST uint LIGHT_FILTERS = LIGHT_KINDS + 3u;    ///< a light's map has another filter than SHADOW_PCF
IRAD_CONST uint LIGHT_CONSTANTS = LIGHT_KINDS + 4u;  ///< how many there are

/// Whether a kind has any of `wanted`; false of a number that is no kind's.
IRAD_FN bool lightHas(uint kind, uint wanted) {
#define IRAD_LIGHT_HAS(constant, number, id, effect, gltf, name, one, many, map, traits) \
  || (((traits) & wanted) != 0u && kind == LIGHT_##constant)
  return false IRAD_LIGHT_KINDS(IRAD_LIGHT_HAS);
#undef IRAD_LIGHT_HAS
}

/// Whether a light's shadow is drawn in six cube faces.
IRAD_FN bool lightUsesCube(uint kind, float outerCos) {
  bool wide = outerCos < 0.342f;  // a half-angle over 70 degrees
#define IRAD_LIGHT_CUBE(constant, number, id, effect, gltf, name, one, many, map, traits) \
  || ((map == LIGHT_MAP_CUBE || (map == LIGHT_MAP_CONE && wide)) && kind == LIGHT_##constant)
  return false IRAD_LIGHT_KINDS(IRAD_LIGHT_CUBE);
#undef IRAD_LIGHT_CUBE
}

IRAD_END
#endif
