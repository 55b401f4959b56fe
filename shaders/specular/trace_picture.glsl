// "RE Specular" of every pixel by itself, where kernels rasterize.
#include "specular/trace_pixel.glsl"

layout(local_size_x = 64) in;
layout(set = 0, binding = 5, rgba32f) uniform writeonly image2D specularTarget;

void main() {
  // Neighbours in a subgroup are neighbours in the picture: 4 x 2 pixels, of which 2 x 4 make a group.
  uint i = gl_LocalInvocationIndex;
  ivec2 pixel = ivec2(8u * gl_WorkGroupID.xy + uvec2((i & 3u) | ((i >> 1) & 4u), ((i >> 2) & 1u) | ((i >> 3) & 6u)));
  if (any(greaterThanEqual(pixel, imageSize(specularTarget)))) return;
  imageStore(specularTarget, pixel, specularOf(pixel));
}
