// Distance fields by brute force: every voxel against every solid voxel.
#pragma once

#include <vector>

#include "shaders/shared/grid.h"

namespace irad::oracle {

/// Chebyshev distance to the nearest solid voxel, 255 at most.
std::vector<uint8_t> chebyshev(const Grid& grid, const std::vector<bool>& solid);
/// Squared Euclidean distance to the nearest solid voxel; UINT32_MAX where there is none.
std::vector<uint32_t> squaredDistance(const Grid& grid, const std::vector<bool>& solid);

}  // namespace irad::oracle
