// listPieces() of every triangle: one invocation per tile of columns along the triangle's dominant axis.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "gi/list_pieces.h"
#include "gi/voxel_triangle.glsl"
#include "gi/triangle_hit.h"
layout(local_size_x = 64) in;
layout(push_constant, scalar) uniform Push { ListPiecesPush push; };

void main() {
  uint tile = irad_index();
  if (tile >= push.tileCount) return;
  tile += push.firstTile;
  // The last triangle that starts at or before this tile.
  uint triangle = push.firstTriangle;
  uint end = push.endTriangle;
  while (end - triangle > 1u) {
    uint middle = (triangle + end) / 2u;
    if (push.tileStart.at[middle] <= tile) triangle = middle;
    else end = middle;
  }
  // The area of a face that is there twice counts once.
  if (firstInPlace(push.corners, triangle) != triangle) return;
  VoxelTriangle t = loadTriangle(push.scene, push.grid, triangle);
  uvec3 dims = push.grid.at[0].dims;
  ivec3 lo, hi;
  cellBounds(t, dims, lo, hi);
  lo = dominantLast(lo, t.axis);
  hi = dominantLast(hi, t.axis);
  uvec2 tiles;
  int edge = int(tileEdge(uvec2(hi.xy - lo.xy + 1), tiles));
  uint local = tile - push.tileStart.at[triangle];
  ivec2 first = lo.xy + ivec2(local % tiles.x, local / tiles.x) * edge;
  ivec2 last = min(first + edge - 1, hi.xy);
  listPieces(push, t, triangle, dims, lo, hi, first, last);
}
