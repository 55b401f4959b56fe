// What suns, spots and points send to a point, shadows apart: one definition for shading, for the gather of direct light
// and for the host's. Shaders include it by forward/light.glsl.
#ifndef IRAD_FORWARD_LIGHT_H
#define IRAD_FORWARD_LIGHT_H
#include "forward/precise.h"
#include "shared/sampling.h"
#include "shared/scene_gpu.h"
#include "shared/surface.h"
IRAD_BEGIN

#ifdef __cplusplus
IRAD_FN bool lightHas(const GpuLight& light, uint wanted) { return lightHas(light.type, wanted); }
IRAD_FN bool hasSize(const GpuLight& light) { return light.size > 0.0f; }
#endif

/// `reach` of what is far away.
IRAD_CONST float UNREACHED = 1e30f;

/// Unit vector from `position` towards the light.
IRAD_FN vec3 lightDirection(GpuLight light, vec3 position) {
  return lightHas(light, LIGHT_DISTANT) ? -light.direction : preciseNormalize(light.position - position);
}

/// How far away it is, m, or UNREACHED.
IRAD_FN float lightReach(GpuLight light, vec3 position) {
  return lightHas(light, LIGHT_DISTANT) ? UNREACHED : length(light.position - position);
}

/// Of such a reach; `edge`: of a voxel, m.
IRAD_FN float inVoxels(float reach, float edge) { return reach < UNREACHED ? reach / edge : reach; }

/// Point k of n of a light with a size: of the disc that is seen of it, whose shadows a surface gets one by one.
/// `reach`: as lightReach.
IRAD_FN vec3 lightPoint(GpuLight light, vec3 position, uint k, uint n, uvec2 shift, IRAD_INOUT(float) reach) {
  vec3 middle = lightDirection(light, position);
  vec2 u = hammersley(k, n, shift);
  float r = light.size * sqrt(u.x), phi = 2.0f * IRAD_PI * u.y;
  vec3 aside = toWorld(vec3(r * cos(phi), r * sin(phi), 0.0f), middle);
  if (lightHas(light, LIGHT_DISTANT)) {
    reach = UNREACHED;
    return normalize(middle + aside);
  }
  vec3 way = light.position - position + aside;
  reach = length(way);
  return way / reach;
}

/// Light that reaches `position` on a surface facing it, W/m^2: lux for a distant one, I / d^2 times KHR_lights_punctual's range
/// window for the others, times the squared angular ramp of a cone. Shadows apart.
IRAD_FN vec3 lightIntensity(GpuLight light, vec3 position) {
  if (lightHas(light, LIGHT_DISTANT)) return light.intensity;
  vec3 toLight = light.position - position;
  float d2 = preciseDot(toLight, toLight);
  if (!(d2 > 0.0f)) return vec3(0.0f);
  IRAD_PRECISE float attenuation = 1.0f / d2;
  if (light.range > 0.0f) {
    float r2 = d2 / (light.range * light.range);
    attenuation *= clamp(1.0f - r2 * r2, 0.0f, 1.0f);
  }
  if (lightHas(light, LIGHT_CONE)) {
    float c = preciseDot(light.direction, -toLight) * inversesqrt(d2);
    float ramp = light.innerCos > light.outerCos
                     ? clamp((c - light.outerCos) / (light.innerCos - light.outerCos), 0.0f, 1.0f)
                     : (c >= light.outerCos ? 1.0f : 0.0f);
    attenuation *= ramp * ramp;
  }
  return light.intensity * attenuation;
}

/// Irradiance of the unshadowed light on a surface with this normal, W/m^2.
IRAD_FN vec3 lightIrradiance(GpuLight light, vec3 position, vec3 normal) {
  float cosine = dot(normal, lightDirection(light, position));
  return cosine > 0.0f ? lightIntensity(light, position) * cosine : vec3(0.0f);
}

/// A light's points that the surfels of a facet look at: all of them the same number.
IRAD_FN uint pointsForSurfels(GpuLight light) {
  return (light.points + FACET_SURFELS - 1u) / FACET_SURFELS * FACET_SURFELS;
}

IRAD_END
#endif
