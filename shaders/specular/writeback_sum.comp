// "GI Writeback", writeback.mode = compute, second: the values of each facet's pixels are added up, as integers, in
// steps of a share of the largest one.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "specular/writeback_pixel.glsl"

layout(local_size_x = 8, local_size_y = 8) in;

void add(uint word, uint value) {
  for (uint part = 0u; part < WRITEBACK_PARTS; ++part) {
    uint share = (value >> (8u * part)) & 0xFFu;
    if (share != 0u) atomicAdd(push.sums.at[word + part], share);
  }
}

void main() {
  GpuCamera camera = push.camera.at[0];
  if (any(greaterThanEqual(gl_GlobalInvocationID.xy, camera.size))) return;
  float most = uintBitsToFloat(push.counts.at[0].most);
  if (most == 0.0) return;
  WrittenPixel w = writtenPixel(camera, ivec2(gl_GlobalInvocationID.xy));
  if (w.facet == NO_FACET) return;
  for (uint c = 0u; c < 3u; ++c)
    add(WRITEBACK_PARTS * (3u * w.facet + c), uint(round(min(w.value[c] / most, 1.0) * WRITEBACK_STEPS)));
}
