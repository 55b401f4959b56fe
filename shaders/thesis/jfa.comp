// Jump flooding, one pass (T 5.2): the nearest of the seeds known to the 27 voxels `step` apart. A voxel that is its
// own seed cannot improve. Among equally near seeds the first one found stays, which is deterministic, since passes
// ping-pong.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "shared/voxelize.h"
layout(local_size_x = 64) in;
layout(push_constant, scalar) uniform Push { FieldPush push; };

void main() {
  uint voxel = irad_index();
  if (voxel >= push.grid.at[0].voxels) return;
  uvec3 dims = push.grid.at[0].dims;
  ivec3 at = ivec3(voxelOf(voxel, dims));
  uint seed = push.source.at[voxel];
  uint self = packVoxel(uvec3(at));
  if (seed != self) {
    int best = 0x7FFFFFFF;
    if (seed != NO_SEED) {
      ivec3 d = ivec3(unpackVoxel(seed)) - at;
      best = d.x * d.x + d.y * d.y + d.z * d.z;
    }
    int step = int(push.step);
    for (int z = -1; z <= 1; ++z) {
      int nz = at.z + z * step;
      if (nz < 0 || nz >= int(dims.z)) continue;
      for (int y = -1; y <= 1; ++y) {
        int ny = at.y + y * step;
        if (ny < 0 || ny >= int(dims.y)) continue;
        for (int x = -1; x <= 1; ++x) {
          int nx = at.x + x * step;
          if (nx < 0 || nx >= int(dims.x)) continue;
          uint other = push.source.at[voxelIndex(uvec3(nx, ny, nz), dims)];
          if (other == NO_SEED || other == seed) continue;
          ivec3 d = ivec3(unpackVoxel(other)) - at;
          int distance2 = d.x * d.x + d.y * d.y + d.z * d.z;
          if (distance2 < best) {
            best = distance2;
            seed = other;
          }
        }
      }
    }
  }
  push.target.at[voxel] = seed;
}
