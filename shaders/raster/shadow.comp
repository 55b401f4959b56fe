// "RE Shadow" by kernels: per pixel the bits of the largest depth (reversed: the nearest), 0 where there is nothing.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "raster/scene_triangle.glsl"

void rasterPixel(uint triangle, ivec2 pixel, float depth) {
  uint place = uint(pixel.y) * push.size.x + uint(pixel.x);
  uint bits = floatBitsToUint(depth);
  // Reading first pays only where it saves texture reads: nobody waits for the atomics.
  if (MASKED) {
    uint corner = push.scene.at[0].indices.at[3u * triangle];
    float threshold = texelThreshold(uint(pixel.x), uint(pixel.y), corner);
    if (push.target.at[place] >= bits || cutOut(pixel, threshold, push.channel)) return;
  }
  atomicMax(push.target.at[place], bits);
}
