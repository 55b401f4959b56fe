// "GI Writeback" as in the thesis (T 5.12): the fragments that the mask selects store the reflection that they show at
// their facet. Where there are several which of them does so last is anybody's guess; they are counted.
#include "specular/writeback_pixel.glsl"

layout(set = 0, binding = 6, rgba32f) uniform writeonly image2D stored;

void writeBack(GpuCamera camera, ivec2 pixel) {
  WrittenPixel w = writtenPixel(camera, pixel);
  if (w.facet == NO_FACET) return;
  atomicAdd(push.pixels.at[w.facet], 1u);
  if (!writebackSelects(w.distance_, w.position, w.face, push.params)) return;
  atomicAdd(push.writers.at[w.facet], 1u);
  imageStore(stored, writebackTexel(w.facet), vec4(w.value, 1.0));
}
