// The share of one light that its shadow map lets through to the surface, as shading has it.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "shared/view.h"
#include "forward/shadow.glsl"
#include "view/camera_ray.glsl"

layout(local_size_x = 8, local_size_y = 8) in;
layout(set = 0, binding = 2) uniform sampler2D depthTarget;
layout(set = 0, binding = 3, rgba16f) uniform readonly image2D geometricTarget;
layout(set = 0, binding = 4, rgba32f) uniform writeonly image2D linearTarget;
layout(push_constant, scalar) uniform PushBlock { ShadowViewPush push; };

void main() {
  GpuCamera camera = push.camera.at[0];
  uvec2 pixel = gl_GlobalInvocationID.xy;
  if (any(greaterThanEqual(pixel, camera.size))) return;
  float depth = texelFetch(depthTarget, ivec2(pixel), 0).r;
  vec4 drawn = vec4(0.0);
  if (depth > 0.0) {
    GpuLight light = push.lights.at[push.light];
    vec3 p = unproject(camera, pixel, depth);
    vec3 n = imageLoad(geometricTarget, ivec2(pixel)).xyz;
    // A surface that faces away is in its own shadow.
    bool faces = dot(n, lightDirection(light, p)) > 0.0;
    drawn = vec4(vec3(faces ? shadowVisibility(light, p, n, push.shadowBias, push.pcf) : 0.0), 1.0);
  }
  imageStore(linearTarget, ivec2(pixel), drawn);
}
