// "RE Depth" by kernels: per pixel the least of ~(bits of the depth) << 32 | triangle: the nearest, depth being 1
// at the near plane and 0 at the far one, and of equals the first.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "raster/scene_triangle.glsl"

void rasterPixel(uint triangle, ivec2 pixel, float depth) {
  uint place = uint(pixel.y) * push.size.x + uint(pixel.x);
  uint bits = ~floatBitsToUint(depth);
  // Reading the depth first (one load reads it whole) pays only where it saves texture reads: nobody waits for the
  // atomics.
  if (MASKED) {
    if (push.target.at[2u * place + 1u] < bits) return;
    // Blended surfaces behind what the last layer has seen alone, in the order by which that was chosen.
    if (push.peels != 0u && (current.material.flags & MATERIAL_BLEND) != 0u) {
      uint before = push.peeled.at[2u * place + 1u];
      if (bits < before || (bits == before && triangle <= push.peeled.at[2u * place])) return;
    }
    if (cutOut(pixel, 0.0, PANE_WHOLE)) return;
  }
  atomicMin(VisibleArray(push.target).at[place], pack64(uvec2(triangle, bits)));
}
