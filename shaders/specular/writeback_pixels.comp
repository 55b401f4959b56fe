// "GI Writeback", writeback.mode = compute, first: how many pixels see each facet, and the largest value of a pixel.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "specular/writeback_pixel.glsl"

layout(local_size_x = 8, local_size_y = 8) in;
shared uint most;

void main() {
  if (gl_LocalInvocationIndex == 0u) most = 0u;
  barrier();
  GpuCamera camera = push.camera.at[0];
  if (all(lessThan(gl_GlobalInvocationID.xy, camera.size))) {
    WrittenPixel w = writtenPixel(camera, ivec2(gl_GlobalInvocationID.xy));
    if (w.facet != NO_FACET) atomicAdd(push.pixels.at[w.facet], 1u);
    atomicMax(most, floatBitsToUint(max(w.value.r, max(w.value.g, w.value.b))));
  }
  barrier();
  if (gl_LocalInvocationIndex == 0u && most > 0u) atomicMax(push.counts.at[0].most, most);
}
