#include "gi/grid.h"

#include <algorithm>
#include <bit>
#include <cmath>

#include "renderer/base/error.h"

namespace irad {
namespace {

/// The scene's bounds lie this far (in voxels) inside the faces of the inner cells of its longest axis: the outer walls
/// of an axis-aligned room then fall into the outermost inner cells on both sides alike, whatever their coordinates
/// round to. docs/method.md 2's delta = extent / N grows by 2 kInset / N for it (0.01 % at N = 64).
constexpr double kInset = 1.0 / 256.0;

}  // namespace

void checkGridInput(const glm::vec3& lo, const glm::vec3& hi, uint32_t resolution, uint32_t largest) {
  for (int a = 0; a < 3; ++a)
    IRAD_CHECK(std::isfinite(lo[a]) && std::isfinite(hi[a]) && lo[a] <= hi[a], "scene bounds [{}, {}] on axis {}",
               lo[a], hi[a], a);
  if (resolution < 1 || resolution > largest)
    throw UsageError(fmt::format("voxel.resolution = {} is outside 1..{}: a voxel's coordinates have 10 bits per axis",
                                 resolution, largest));
}

Grid finishedGrid(Grid grid) {
  // Every axis has at least two Morton bits, so that 64 consecutive codes are a block of 4 x 4 x 4.
  grid.inverseEdge = 1.0f / grid.edge;
  for (int a = 0; a < 3; ++a) {
    IRAD_CHECK_OP(grid.dims[a], <=, kLargestAxis);
    grid.mortonBits[a] = std::max(2, static_cast<int>(std::bit_width(grid.dims[a] - 1)));
  }
  grid.voxels = grid.dims.x * grid.dims.y * grid.dims.z;
  return grid;
}

Grid makeGrid(glm::vec3 boundsMin, glm::vec3 boundsMax, uint32_t resolution) {
  checkGridInput(boundsMin, boundsMax, resolution, kLargestAxis - 2);
  const glm::dvec3 lo(boundsMin), hi(boundsMax);
  const glm::dvec3 extent = hi - lo;
  const double largest = std::max({extent.x, extent.y, extent.z});
  const double n = resolution;
  Grid grid{};
  // A scene without extent (a point, or empty) gets one inner voxel of unit size.
  grid.edge = largest > 0 ? static_cast<float>(largest / (n - 2 * kInset)) : 1.0f;
  for (int a = 0; a < 3; ++a) {
    // N_a = max(1, ceil(extent_a / delta)) + 2. An extent that is a whole number of voxels but for rounding is taken as
    // that number: the inset has room for it.
    const double cells = largest > 0 ? std::ceil(extent[a] * n / largest * (1 - kInset / n)) : 1;
    grid.dims[a] = static_cast<uint32_t>(std::max(1.0, cells)) + 2;
    // The bounds are centred: a plane of no thickness lies in the middle of its voxels.
    grid.origin[a] = static_cast<float>((lo[a] + hi[a]) / 2 - grid.dims[a] * static_cast<double>(grid.edge) / 2);
  }
  return finishedGrid(grid);
}

}  // namespace irad
