// The ray through a pixel's centre, in local space: `direction` is unit, its origin the eye (or on the near plane of an
// orthographic camera).
#ifndef IRAD_VIEW_CAMERA_RAY_GLSL
#define IRAD_VIEW_CAMERA_RAY_GLSL
#include "shared/scene_gpu.h"

/// Local position of a pixel's centre at `depth` (1: near plane, 0: far plane).
vec3 unproject(GpuCamera camera, uvec2 pixel, float depth) {
  vec2 ndc = (vec2(pixel) + 0.5) / vec2(camera.size) * vec2(2.0, -2.0) + vec2(-1.0, 1.0);
  vec4 p = camera.inverseViewProjection * vec4(ndc, depth, 1.0);
  return p.xyz / p.w;
}

void cameraRay(GpuCamera camera, uvec2 pixel, out vec3 origin, out vec3 direction) {
  origin = camera.orthographic != 0u ? unproject(camera, pixel, 1.0) : camera.position;
  direction = normalize(unproject(camera, pixel, 0.0) - origin);
}

#endif
