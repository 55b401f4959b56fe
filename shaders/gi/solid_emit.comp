// The solid voxels in Morton order, and where the pieces of each begin.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "gi/facet_block.glsl"
#include "shared/surface.h"
layout(local_size_x = 64) in;
layout(push_constant, scalar) uniform Push { SolidPush push; };

void main() {
  uint block = irad_index();
  if (block >= push.blocks) return;
  uvec3 dims = push.grid.at[0].dims;
  uvec3 corner = mortonDecode(block * 64u, push.grid.at[0].mortonBits);
  uint solid = push.blockSolid.at[block], piece = push.blockPieces.at[block];
  for (uint code = 0u; code < 64u; ++code) {
    uvec3 v = corner + inBlock(code);
    if (any(greaterThanEqual(v, dims))) continue;
    uint index = voxelIndex(v, dims);
    uint count = push.counts.at[index];
    if (count == 0u) continue;
    push.solid.at[solid] = packVoxel(v);
    push.firstPiece.at[solid] = piece;
    push.counts.at[index] = piece;
    ++solid;
    piece += count;
  }
}
