// Conservative voxelization, step 1: how many tiles of columns each triangle has.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "voxel_triangle.glsl"
layout(local_size_x = 64) in;
layout(push_constant, scalar) uniform Push { VoxelizePush push; };

void main() {
  uint triangle = irad_index();
  if (triangle >= push.endTriangle) return;
  VoxelTriangle t = loadTriangle(push.scene, push.grid, triangle);
  uint count = 0u;
  ivec3 lo, hi;
  if (!degenerate(t) && cellBounds(t, push.grid.at[0].dims, lo, hi)) {
    ivec3 size = dominantLast(hi - lo + 1, t.axis);
    uvec2 tiles;
    tileEdge(uvec2(size.xy), tiles);
    count = tiles.x * tiles.y;
  }
  push.tileStart.at[triangle] = count;
}
