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
    uint u = (t.axis + 1u) % 3u;
    uint w = (t.axis + 2u) % 3u;
    uvec2 tiles;
    tileEdge(uvec2(hi[u] - lo[u] + 1, hi[w] - lo[w] + 1), tiles);
    count = tiles.x * tiles.y;
  }
  push.tileStart.at[triangle] = count;
}
