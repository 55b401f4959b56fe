// Lights in shaders (forward/light.h). Specialization constants leave out those that a scene does not have, from the
// number IRAD_LIGHT_CONSTANTS on.
#ifndef IRAD_FORWARD_LIGHT_GLSL
#define IRAD_FORWARD_LIGHT_GLSL
#include "shared/scene_gpu.h"

#ifndef IRAD_LIGHT_CONSTANTS
#define IRAD_LIGHT_CONSTANTS 0u
#endif
#define IRAD_LIGHT_SHINES(constant, number, id, effect, gltf, name, one, many, map, traits) \
  layout(constant_id = IRAD_LIGHT_CONSTANTS + LIGHT_##constant) const bool SHINES_##constant = true;
IRAD_LIGHT_KINDS(IRAD_LIGHT_SHINES)
#undef IRAD_LIGHT_SHINES
layout(constant_id = IRAD_LIGHT_CONSTANTS + LIGHT_SIZES) const bool SIZES = true;

/// How many kinds shine.
uint shiningKinds() {
#define IRAD_LIGHT_SHINES(constant, number, id, effect, gltf, name, one, many, map, traits) +(SHINES_##constant ? 1u : 0u)
  return 0u IRAD_LIGHT_KINDS(IRAD_LIGHT_SHINES);
#undef IRAD_LIGHT_SHINES
}
bool anyLight() { return shiningKinds() > 0u; }
/// Whether a light that shines has any of these traits; where one kind alone shines it need not be looked at.
bool lightHas(GpuLight light, uint wanted) {
#define IRAD_LIGHT_HAS(constant, number, id, effect, gltf, name, one, many, map, traits) \
  || (((traits) & wanted) != 0u && SHINES_##constant && (shiningKinds() == 1u || light.type == LIGHT_##constant))
  return false IRAD_LIGHT_KINDS(IRAD_LIGHT_HAS);
#undef IRAD_LIGHT_HAS
}

bool hasSize(GpuLight light) { return SIZES && light.size > 0.0; }

#include "forward/light.h"

#endif
