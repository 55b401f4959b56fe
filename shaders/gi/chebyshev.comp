// Chebyshev distance, y and then z: with f the distance over the axes done so far,
//   g(y) = min over y' of max(|y - y'|, f(y')),
// searched outwards from y and ended where |y - y'| reaches the best found: exact, at a cost of the distance itself.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "field_bytes.glsl"
layout(local_size_x = 64) in;
layout(push_constant, scalar) uniform Push { FieldPush push; };

void main() {
  uint voxel = irad_index();
  if (voxel >= push.grid.at[0].voxels) return;
  uvec3 dims = push.grid.at[0].dims;
  uint axis = push.step;
  uint stride = axis == 1u ? dims.x : dims.x * dims.y;
  uint at = voxelOf(voxel, dims)[axis];
  ByteArray source = ByteArray(push.source);
  uint best = uint(source.at[voxel]);
  for (uint k = 1u; k < best; ++k) {
    bool below = k <= at;
    bool above = at + k < dims[axis];
    if (!below && !above) break;
    uint f = 255u;
    if (below) f = uint(source.at[voxel - k * stride]);
    if (above) f = min(f, uint(source.at[voxel + k * stride]));
    best = min(best, max(k, f));
  }
  ByteArray(push.target).at[voxel] = uint8_t(best);
}
