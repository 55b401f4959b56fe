// "RE Depth" by kernels: per pixel the least depth's bits << 32 | triangle, so that of equals the first is seen.
#version 460
#extension GL_GOOGLE_include_directive : require
#define IRAD_UV_GRADIENTS
#include "raster/scene_triangle.glsl"

void rasterPixel(uint triangle, ivec2 pixel, float depth) {
  VisibleArray target = VisibleArray(push.target);
  uint place = uint(pixel.y) * push.size.x + uint(pixel.x);
  uint64_t seen = pack64(uvec2(triangle, floatBitsToUint(depth)));
  if (target.at[place] <= seen || cutOut(triangle, pixel)) return;
  atomicMin(target.at[place], seen);
}
