// Chebyshev distance, x: distance to the nearest solid voxel of the row (255: none within 254), by two sweeps. One
// invocation per row.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "field_bytes.glsl"
layout(local_size_x = 64) in;
layout(push_constant, scalar) uniform Push { FieldPush push; };

void main() {
  uint row = irad_index();
  uvec3 dims = push.grid.at[0].dims;
  if (row >= dims.y * dims.z) return;
  uint first = row * dims.x;
  ByteArray target = ByteArray(push.target);
  uint d = 255u;
  for (uint x = 0u; x < dims.x; ++x) {
    d = push.reverse.at[first + x] != NO_FACET ? 0u : min(d + 1u, 255u);
    target.at[first + x] = uint8_t(d);
  }
  d = 255u;
  for (uint x = dims.x; x-- > 0u;) {
    uint left = uint(target.at[first + x]);
    d = left == 0u ? 0u : min(d + 1u, 255u);
    if (d < left) target.at[first + x] = uint8_t(d);
  }
}
