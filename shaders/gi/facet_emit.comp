// Facet list, step 2: writes voxel and winning triangle of every facet at its place, and the reverse map of every voxel.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "facet_block.glsl"
layout(local_size_x = 64) in;
layout(push_constant, scalar) uniform Push { CompactPush push; };

uint facetTriangle(uint key) { return keyTriangle(key) | (keyBack(key) ? BACK_SIDE : 0u); }

void main() {
  uint block = irad_index();
  if (block >= push.blocks) return;
  uvec3 dims = push.grid.at[0].dims;
  uint voxels = push.grid.at[0].voxels;
  uvec3 corner = mortonDecode(block * 64u, push.grid.at[0].mortonBits);
  if (any(greaterThanEqual(corner, dims))) return;
  uint facet = push.blockCounts.at[block];
  for (uint code = 0u; code < 64u; ++code) {
    uvec3 v = corner + inBlock(code);
    if (any(greaterThanEqual(v, dims))) continue;
    uint index = voxelIndex(v, dims);
    uint first = facet;
    for (uint slot = 0u; slot < push.slots; ++slot) {
      uint key = push.keys.at[slot * voxels + index];
      if (key == 0u) continue;
      push.voxel.at[facet] = packVoxel(v);
      push.triangle.at[facet] = facetTriangle(key);
      ++facet;
    }
    push.reverse.at[index] = facet > first ? facetEntryOf(first, facet - first) : NO_FACET;
  }
}
