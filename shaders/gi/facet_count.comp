// Facet list, step 1 (docs/method.md 4): facets per block of 64 voxels in Morton order.
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
  uint facets = 0u;
  if (all(lessThan(corner, dims))) {
    for (uint code = 0u; code < 64u; ++code) {
      uvec3 v = corner + inBlock(code);
      if (any(greaterThanEqual(v, dims))) continue;
      if (push.keys.at[voxelIndex(v, dims)] != 0u) ++facets;
    }
  }
  push.blockCounts.at[block] = facets;
}
