// Sorts the pieces of each solid voxel by triangle: one workgroup per voxel. A piece's place is how many are before it.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "shared/surface.h"
layout(local_size_x = 32) in;
layout(push_constant, scalar) uniform Push { SortPiecesPush push; };

void main() {
  uint voxel = irad_workgroup();
  if (voxel >= push.count) return;
  uint first = push.firstPiece.at[voxel], end = push.firstPiece.at[voxel + 1u];
  for (uint i = first + gl_LocalInvocationID.x; i < end; i += gl_WorkGroupSize.x) {
    uint triangle = push.pieces.at[i];
    uint place = first;
    for (uint j = first; j < end; ++j) place += push.pieces.at[j] < triangle ? 1u : 0u;
    push.sorted.at[place] = triangle;
    push.pieceVoxel.at[place] = voxel;
  }
}
