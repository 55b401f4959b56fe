// Two solutions of one scene, voxel by voxel.
#pragma once

#include "renderer/metrics.h"

namespace irad {

struct VolumeValues;

/// The irradiance of one solution against that of another. Voxels of `reference` are matched with the voxel of `values`
/// that holds their centre, so that grids of other sizes compare too.
struct VoxelMetrics {
  Metrics irradiance;        ///< of H, W/m^2, over the voxels that are solid in both
  size_t onlyValues = 0;     ///< solid voxels of `values` without a counterpart
  size_t onlyReference = 0;  ///< and of `reference`
};
VoxelMetrics compareVoxels(const VolumeValues& values, const VolumeValues& reference);

}  // namespace irad
