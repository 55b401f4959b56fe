// "RE Specular" of every pixel by itself, where kernels rasterize: two invocations per pixel, which take its rays in
// turn, since a ray is a long row of loads of which each waits for the one before.
#define TRACE_AHEAD 8
#include "specular/trace_pixel.glsl"

const uint PIXELS = 64u;
layout(local_size_x = 2u * PIXELS) in;
layout(set = 0, binding = 5, rgba32f) uniform writeonly image2D specularTarget;
shared vec3 second[PIXELS];

void main() {
  // Neighbours in a subgroup are neighbours in the picture: 4 x 2 pixels, of which 2 x 4 make a group.
  uint i = gl_LocalInvocationIndex % PIXELS;
  uint turn = gl_LocalInvocationIndex / PIXELS;
  ivec2 pixel = ivec2(8u * gl_WorkGroupID.xy + uvec2((i & 3u) | ((i >> 1) & 4u), ((i >> 2) & 1u) | ((i >> 3) & 6u)));
  bool within = all(lessThan(pixel, imageSize(specularTarget)));
  Reflection r;
  r.traces = false;
  if (within) r = reflectionAt(pixel);
  vec3 met = vec3(0.0);
  for (uint k = 0u; k < push.params.rays; k += 2u) {
    vec3 ray = vec3(0.0);
    if (r.traces && k + turn < push.params.rays) ray = traceJittered(reflectedWorld(), r.surface, r.seed, k + turn);
    if (turn == 1u) second[i] = ray;
    barrier();
    met = met + ray + second[i];
    barrier();
  }
  if (within && turn == 0u) imageStore(specularTarget, pixel, specularOf(r, met));
}
