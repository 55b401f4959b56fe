// "RE Specular" of every listed pixel by itself, where kernels rasterize: two invocations per pixel, which take its
// rays in turn, since a ray is a long chain of loads, each of which waits for the one before.
#version 460
#extension GL_GOOGLE_include_directive : require
#define TRACE_AHEAD 16
#include "thesis/specular_pixel.glsl"

layout(local_size_x = 2u * PICKED_GROUP) in;
layout(set = 0, binding = 5, rgba32f) uniform writeonly image2D specularTarget;
shared vec3 second[PICKED_GROUP];

void main() {
  uint i = gl_LocalInvocationIndex % PICKED_GROUP;
  uint turn = gl_LocalInvocationIndex / PICKED_GROUP;
  ivec2 pixel;
  Reflection r;
  r.traces = false;
  if (pickedPixel(push.glossy, gl_WorkGroupID.x * PICKED_GROUP + i, pixel)) r = reflectionAt(pixel);
  vec3 met = vec3(0.0);
  for (uint k = 0u; k < push.params.rays; k += 2u) {
    vec3 ray = vec3(0.0);
    if (r.traces && k + turn < push.params.rays) ray = traceJittered(reflectedWorld(), r.surface, r.seed, k + turn);
    if (turn == 1u) second[i] = ray;
    barrier();
    met = met + ray + second[i];
    barrier();
  }
  if (r.traces && turn == 0u) imageStore(specularTarget, pixel, specularOf(r, met));
}
