// Jump flooding, the final write (T 5.2): the nearest seed and the Euclidean distance to it, in units of the largest
// dimension (8-bit UNORM: docs/method.md 3 says what that costs).
#version 460
#extension GL_GOOGLE_include_directive : require
#include "shared/voxelize.h"
layout(local_size_x = 64) in;
layout(push_constant, scalar) uniform Push { FieldPush push; };
layout(set = 0, binding = 0, r8) uniform writeonly image3D distances;
layout(set = 0, binding = 1, r32ui) uniform writeonly uimage3D seeds;

void main() {
  uint voxel = irad_index();
  if (voxel >= push.grid.at[0].voxels) return;
  ivec3 at = ivec3(voxelOf(voxel, push.grid.at[0].dims));
  uint seed = push.source.at[voxel];
  float share = 1.0;
  if (seed != NO_SEED) share = min(length(vec3(ivec3(unpackVoxel(seed)) - at)) * push.scale, 1.0);
  imageStore(distances, at, vec4(share));
  imageStore(seeds, at, uvec4(seed));
}
