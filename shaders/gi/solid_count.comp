// Solid voxels and their pieces per block of 64 voxels, in Morton order.
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
  uint solid = 0u, pieces = 0u, most = 0u;
  for (uint code = 0u; code < 64u; ++code) {
    uvec3 v = corner + inBlock(code);
    if (any(greaterThanEqual(v, dims))) continue;
    uint count = push.counts.at[voxelIndex(v, dims)];
    solid += count > 0u ? 1u : 0u;
    pieces += count;
    most = max(most, count);
  }
  push.blockSolid.at[block] = solid;
  push.blockPieces.at[block] = pieces;
  if (most > push.most.at[0]) atomicMax(push.most.at[0], most);
}
