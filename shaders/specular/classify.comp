// "RE Specular", first step: every pixel takes the reflection of its diffuse irradiance, and those that trace rays are
// listed, so that the steps which follow run on them alone. For the filter -1 (w) marks the others.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "specular/surface.glsl"
#include "shared/constants.h"

layout(local_size_x = 8, local_size_y = 8) in;
layout(constant_id = CONSTANT_FILTERED) const bool FILTERED = true;
layout(set = 0, binding = 0) uniform sampler2D depthTarget;
layout(set = 0, binding = 1, rgba16f) uniform readonly image2D normalTarget;
layout(set = 0, binding = 2, rgba16f) uniform readonly image2D f0Target;
layout(set = 0, binding = 3, rgba32f) uniform readonly image2D indirectTarget;
layout(set = 0, binding = 4, rgba32f) uniform writeonly image2D tracedTarget;
layout(set = 0, binding = 5, rgba32f) uniform writeonly image2D specularTarget;

// A workgroup adds to the list once.
shared uint listed, first;

/// Writes its reflection; true: it traces.
bool classify(GpuCamera camera, ivec2 pixel) {
  float depth = texelFetch(depthTarget, pixel, 0).r;
  vec4 normal = imageLoad(normalTarget, pixel);
  vec4 f0 = imageLoad(f0Target, pixel);
  vec3 irradiance = imageLoad(indirectTarget, pixel).rgb;
  vec3 result = vec3(0.0);
  bool traces = false;
  if (depth > 0.0 && f0.w != 0.0) {
    vec3 axis = viewAxis(camera);
    vec3 view = towardsViewer(camera, pixelPosition(camera, pixel, viewDepth(camera, depth), axis), axis);
    float nv = max(dot(normalize(normal.xyz), view), 1e-3);
    result = irradiance * (1.0 / IRAD_PI) * environmentBrdf(f0.rgb, normal.w, nv);
    traces = !tracesNothing(f0, normal.w, irradiance);
  }
  if (FILTERED) imageStore(tracedTarget, pixel, vec4(0.0, 0.0, 0.0, -1.0));
  imageStore(specularTarget, pixel, vec4(result, FILTERED ? -1.0 : 1.0));
  return traces;
}

void main() {
  if (gl_LocalInvocationIndex == 0u) listed = 0u;
  barrier();
  GpuCamera camera = push.camera.at[0];
  ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
  bool traces = all(lessThan(gl_GlobalInvocationID.xy, camera.size)) && classify(camera, pixel);
  uint place = 0u;
  if (traces) place = atomicAdd(listed, 1u);
  barrier();
  if (listed == 0u) return;
  if (gl_LocalInvocationIndex == 0u) {
    first = atomicAdd(push.glossy.at[PICKED_COUNT], listed);
    atomicMax(push.glossy.at[0], (first + listed + PICKED_GROUP - 1u) / PICKED_GROUP);
  }
  barrier();
  if (traces) push.glossy.at[PICKED_FIRST + first + place] = packPixel(pixel);
}
