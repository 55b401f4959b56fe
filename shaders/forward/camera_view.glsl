// Where the points that a camera shows lie, and from where they are seen, in local space.
#include "shared/scene_gpu.h"

/// Distance along the view direction, of a depth that is 1 at the near plane and 0 at the far one.
float viewDepth(GpuCamera camera, float depth) {
  return camera.orthographic != 0u ? mix(camera.zfar, camera.znear, depth)
                                   : camera.znear * camera.zfar / (camera.znear + depth * (camera.zfar - camera.znear));
}

/// Direction in which the camera looks: the gradient of clip w, or against that of clip z where w is constant.
vec3 viewAxis(GpuCamera camera) {
  mat4 m = camera.viewProjection;
  return camera.orthographic != 0u ? -normalize(vec3(m[0][2], m[1][2], m[2][2])) : vec3(m[0][3], m[1][3], m[2][3]);
}

/// Local position of a pixel's centre at view depth z. The first two columns of the inverse span the picture plane at
/// unit depth.
vec3 pixelPosition(GpuCamera camera, ivec2 pixel, float z, vec3 axis) {
  vec2 ndc = (vec2(pixel) + 0.5) / vec2(camera.size) * vec2(2.0, -2.0) + vec2(-1.0, 1.0);
  vec3 aside = camera.inverseViewProjection[0].xyz * ndc.x + camera.inverseViewProjection[1].xyz * ndc.y;
  return camera.position + axis * z + aside * (camera.orthographic != 0u ? 1.0 : z);
}

/// Unit. `axis`: viewAxis.
vec3 towardsViewer(GpuCamera camera, vec3 position, vec3 axis) {
  return camera.orthographic != 0u ? -axis : normalize(camera.position - position);
}
