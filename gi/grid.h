// The voxel grid (docs/method.md 2, T 5.1.1).
#pragma once

#include "shaders/shared/grid.h"

namespace irad {

/// Bounds are local fp32; the arithmetic is double. Throws UsageError when an axis would exceed 1022 + 2 voxels.
Grid makeGrid(glm::vec3 boundsMin, glm::vec3 boundsMax, uint32_t resolution);

// ---- For makers of grids ----

inline constexpr uint32_t kLargestAxis = 1024;  ///< packVoxel: 10 bits per axis
/// Throws UsageError for a resolution beyond `largest`; bounds are finite and in order.
void checkGridInput(const glm::vec3& lo, const glm::vec3& hi, uint32_t resolution, uint32_t largest);
/// With the members that follow from dims and edge.
Grid finishedGrid(Grid grid);

}  // namespace irad
