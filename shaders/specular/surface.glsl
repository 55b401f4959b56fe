// The G-buffer as specular tracing and its filter read it.
#include "shared/ggx.h"
#include "shared/passes.h"

layout(push_constant, scalar) uniform PushBlock {
  SpecularPush push;
};

/// Distance along the view direction.
float viewDepth(GpuCamera camera, float depth) {
  return camera.orthographic != 0u ? mix(camera.znear, camera.zfar, depth)
                                   : camera.znear * camera.zfar / (camera.zfar - depth * (camera.zfar - camera.znear));
}

/// Direction in which the camera looks: the gradient of clip w, or of clip z where w is constant.
vec3 viewAxis(GpuCamera camera) {
  mat4 m = camera.viewProjection;
  return camera.orthographic != 0u ? normalize(vec3(m[0][2], m[1][2], m[2][2])) : vec3(m[0][3], m[1][3], m[2][3]);
}

/// Local position of a pixel's centre at view depth z. The first two columns of the inverse span the picture plane at
/// unit depth.
vec3 pixelPosition(GpuCamera camera, ivec2 pixel, float z, vec3 axis) {
  vec2 ndc = (vec2(pixel) + 0.5) / vec2(camera.size) * vec2(2.0, -2.0) + vec2(-1.0, 1.0);
  vec3 aside = camera.inverseViewProjection[0].xyz * ndc.x + camera.inverseViewProjection[1].xyz * ndc.y;
  return camera.position + axis * z + aside * (camera.orthographic != 0u ? 1.0 : z);
}

vec3 towardsViewer(GpuCamera camera, vec3 position, vec3 axis) {
  return camera.orthographic != 0u ? -axis : normalize(camera.position - position);
}

/// Share of the traced reflection, 1 below max_roughness - fade.
float tracedShare(float roughness) {
  return clamp((push.params.maxRoughness - roughness) / max(push.params.fade, 1e-4), 0.0, 1.0);
}

/// The pixel of this invocation of a dispatch over Targets::glossy; false past its end.
bool glossyPixel(uint invocation, out ivec2 pixel) {
  pixel = ivec2(0);
  if (invocation >= push.glossy.at[GLOSSY_COUNT]) return false;
  uint packed_ = push.glossy.at[GLOSSY_FIRST + invocation];
  pixel = ivec2(packed_ & 0xFFFFu, packed_ >> 16);
  return true;
}

/// No rays: no lobe, too rough, or too little light here to matter (METHOD section 8). The targets hold roughness in
/// half precision, which some devices truncate: a material at max_roughness would come back below it.
bool tracesNothing(vec4 f0, float roughness, vec3 irradiance) {
  if (f0.w == 0.0 || roughness * (1.0 + 1.0 / 1024.0) >= push.params.maxRoughness) return true;
  vec3 reflected = f0.rgb * irradiance;
  return max(reflected.r, max(reflected.g, reflected.b)) < push.leastReflected;
}
