// The boxes around groups of a voxel's pieces: one invocation per voxel.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "shared/surface.h"
layout(local_size_x = 64) in;
layout(push_constant, scalar) uniform Push { PieceGroupsPush push; };

void main() {
  uint voxel = irad_index();
  if (voxel >= push.count) return;
  uint first = push.firstPiece.at[voxel];
  for (uint end = push.firstPiece.at[voxel + 1u]; end >= first + PIECE_GROUP; end -= PIECE_GROUP) {
    uint box = push.boxes.at[end - 1u];
    for (uint i = 2u; i <= PIECE_GROUP; ++i) box = boxAround(box, push.boxes.at[end - i]);
    push.groups.at[groupPlace(end - PIECE_GROUP)] = box;
  }
}
