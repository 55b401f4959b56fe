// "GI Writeback", writeback.mode = compute, second: the values of each facet's pixels are added up, as integers, in
// steps of a share of the largest one.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "specular/writeback_pixel.glsl"

layout(local_size_x = 8, local_size_y = 8) in;

/// Adds to a 64-bit sum in two words.
void add(uint word, uint64_t value) {
  if (value == 0ul) return;
  uint low = uint(value), before = atomicAdd(push.sums.at[word], low);
  uint high = uint(value >> 32) + (before + low < before ? 1u : 0u);
  if (high != 0u) atomicAdd(push.sums.at[word + 1u], high);
}

void main() {
  GpuCamera camera = push.camera.at[0];
  if (any(greaterThanEqual(gl_GlobalInvocationID.xy, camera.size))) return;
  float most = uintBitsToFloat(push.counts.at[0].most);
  if (most == 0.0) return;
  WrittenPixel w = writtenPixel(camera, ivec2(gl_GlobalInvocationID.xy));
  if (w.facet == NO_FACET) return;
  for (uint c = 0u; c < 3u; ++c)
    add(6u * w.facet + 2u * c, uint64_t(min(w.value[c] / most, 1.0) * WRITEBACK_STEPS));
}
