// Jump flooding, start (T 5.2; Rong and Tan 2006): solid voxels know themselves as the nearest seed.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "shared/voxelize.h"
layout(local_size_x = 64) in;
layout(push_constant, scalar) uniform Push { FieldPush push; };

void main() {
  uint voxel = irad_index();
  if (voxel >= push.grid.at[0].voxels) return;
  bool solid = push.reverse.at[voxel] != NO_FACET;
  push.target.at[voxel] = solid ? packVoxel(voxelOf(voxel, push.grid.at[0].dims)) : NO_SEED;
}
