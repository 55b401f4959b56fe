// What suns, spots and points send to a point, shadows apart: one definition for shading and for the gather of direct
// light. Specialization constants leave out the lights that a scene does not have, from the number IRAD_LIGHT_CONSTANTS
// on.
#ifndef IRAD_FORWARD_LIGHT_GLSL
#define IRAD_FORWARD_LIGHT_GLSL
#include "forward/precise.glsl"
#include "shared/sampling.h"
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

/// Unit vector from `position` towards the light.
vec3 lightDirection(GpuLight light, vec3 position) {
  return lightHas(light, LIGHT_DISTANT) ? -light.direction : preciseNormalize(light.position - position);
}

bool hasSize(GpuLight light) { return SIZES && light.size > 0.0; }

/// Point k of n of a light with a size: of the disc that is seen of it, whose shadows a surface gets one by one.
/// `reach`: how far away it is, m, or 1e30.
vec3 lightPoint(GpuLight light, vec3 position, uint k, uint n, uvec2 shift, out float reach) {
  vec3 middle = lightDirection(light, position);
  vec2 u = hammersley(k, n, shift);
  float r = light.size * sqrt(u.x), phi = 2.0 * IRAD_PI * u.y;
  vec3 aside = toWorld(vec3(r * cos(phi), r * sin(phi), 0.0), middle);
  if (lightHas(light, LIGHT_DISTANT)) {
    reach = 1e30;
    return normalize(middle + aside);
  }
  vec3 way = light.position - position + aside;
  reach = length(way);
  return way / reach;
}

/// Light that reaches `position` on a surface facing it, W/m^2: lux for a distant one, I / d^2 times KHR_lights_punctual's range
/// window for the others, times the squared angular ramp of a cone. Shadows apart.
vec3 lightIntensity(GpuLight light, vec3 position) {
  if (lightHas(light, LIGHT_DISTANT)) return light.intensity;
  vec3 toLight = light.position - position;
  float d2 = preciseDot(toLight, toLight);
  if (!(d2 > 0.0)) return vec3(0.0);
  precise float attenuation = 1.0 / d2;
  if (light.range > 0.0) {
    float r2 = d2 / (light.range * light.range);
    attenuation *= clamp(1.0 - r2 * r2, 0.0, 1.0);
  }
  if (lightHas(light, LIGHT_CONE)) {
    float c = preciseDot(light.direction, -toLight) * inversesqrt(d2);
    float ramp = light.innerCos > light.outerCos
                     ? clamp((c - light.outerCos) / (light.innerCos - light.outerCos), 0.0, 1.0)
                     : (c >= light.outerCos ? 1.0 : 0.0);
    attenuation *= ramp * ramp;
  }
  return light.intensity * attenuation;
}

/// Irradiance of the unshadowed light on a surface with this normal, W/m^2.
vec3 lightIrradiance(GpuLight light, vec3 position, vec3 normal) {
  float cosine = dot(normal, lightDirection(light, position));
  return cosine > 0.0 ? lightIntensity(light, position) * cosine : vec3(0.0);
}

#endif
