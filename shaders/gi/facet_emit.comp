// Facet list, step 2: writes voxel and winning triangle of every facet at its place, and the reverse map of every
// voxel.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "facet_block.glsl"
layout(local_size_x = 64) in;
layout(push_constant, scalar) uniform Push { CompactPush push; };

void main() {
  uint block = irad_index();
  if (block >= push.blocks) return;
  uvec3 dims = push.grid.at[0].dims;
  uvec3 corner = mortonDecode(block * 64u, push.grid.at[0].mortonBits);
  if (any(greaterThanEqual(corner, dims))) return;
  uint facet = push.blockCounts.at[block];
  for (uint code = 0u; code < 64u; ++code) {
    uvec3 v = corner + inBlock(code);
    if (any(greaterThanEqual(v, dims))) continue;
    uint index = voxelIndex(v, dims);
    uint key = push.keys.at[index];
    push.reverse.at[index] = key == 0u ? NO_FACET : facetEntryOf(facet, 1u);
    if (key == 0u) continue;
    push.voxel.at[facet] = packVoxel(v);
    push.triangle.at[facet] = keyTriangle(key);
    ++facet;
  }
}
