// Two solutions of one scene, voxel by voxel.
#pragma once

#include "gi/stages.h"
#include "renderer/metrics.h"

namespace irad {

/// H of one facet list against that of another. A voxel's value is the mean of its facets; voxels of `reference` are
/// matched with the voxel of `values` that holds their centre, so that grids of other sizes compare too.
struct VoxelMetrics {
  Metrics irradiance;        ///< of H, W/m^2, over the voxels that are solid in both
  size_t onlyValues = 0;     ///< solid voxels of `values` without a counterpart
  size_t onlyReference = 0;  ///< and of `reference`
};
/// Blocking.
VoxelMetrics compareVoxels(Context& context, const FacetList& values, const Lighting& valuesLight,
                           const FacetList& reference, const Lighting& referenceLight);

}  // namespace irad
