// Exact distance to the nearest solid voxel, one axis after another (Felzenszwalb and Huttenlocher 2012, by search): what
// jump flooding and the stored fields are measured against.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "shared/constants.h"
#include "shared/facets.h"
#include "shared/view.h"
layout(local_size_x = 64) in;
layout(constant_id = CONSTANT_DISTANCE_METRIC) const uint METRIC = METRIC_EUCLIDEAN;
layout(push_constant, scalar) uniform PushBlock { ExactDistancePush push; };

/// Distance over the axes so far; within the solid set alone before the first.
uint before(uvec3 voxel, uvec3 dims) {
  uint index = voxelIndex(voxel, dims);
  if (push.axis > 0u) return push.source.at[index];
  return push.reverse.at[index] != NO_FACET ? 0u : NO_DISTANCE;
}

void main() {
  Grid grid = push.grid.at[0];
  uint index = irad_index();
  if (index >= grid.voxels) return;
  uvec3 voxel = voxelOf(index, grid.dims);
  uint best = before(voxel, grid.dims);
  // Outwards in both directions, until the way along this axis alone is as long.
  uint along = voxel[push.axis], size = grid.dims[push.axis];
  for (uint s = 1u; s < size; ++s) {
    uint way = METRIC == METRIC_EUCLIDEAN ? s * s : s;
    if (way >= best || (s > along && along + s >= size)) break;
    for (uint k = 0u; k < 2u; ++k) {
      if (k == 0u ? s > along : along + s >= size) continue;
      uvec3 other = voxel;
      other[push.axis] = k == 0u ? along - s : along + s;
      uint rest = before(other, grid.dims);
      if (rest != NO_DISTANCE) best = min(best, METRIC == METRIC_EUCLIDEAN ? rest + way : max(rest, way));
    }
  }
  push.target.at[index] = best;
}
