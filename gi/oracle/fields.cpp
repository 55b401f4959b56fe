#include "gi/oracle/fields.h"

#include <algorithm>
#include <cstdlib>

namespace irad::oracle {
namespace {

/// Calls f(index, |dx|, |dy|, |dz|) for every pair of a voxel and a solid voxel.
template <class F>
void forEachPair(const Grid& grid, const std::vector<bool>& solid, F&& f) {
  std::vector<glm::ivec3> seeds;
  for (uint32_t i = 0; i < grid.voxels; ++i)
    if (solid[i]) seeds.emplace_back(voxelOf(i, grid.dims));
  for (uint32_t i = 0; i < grid.voxels; ++i)
    for (const glm::ivec3& seed : seeds) f(i, glm::uvec3(glm::abs(seed - glm::ivec3(voxelOf(i, grid.dims)))));
}

}  // namespace

std::vector<uint8_t> chebyshev(const Grid& grid, const std::vector<bool>& solid) {
  std::vector<uint8_t> distance(grid.voxels, 255);
  forEachPair(grid, solid, [&](uint32_t i, const glm::uvec3& d) {
    distance[i] = static_cast<uint8_t>(std::min<uint32_t>(distance[i], std::max({d.x, d.y, d.z})));
  });
  return distance;
}

std::vector<uint32_t> squaredDistance(const Grid& grid, const std::vector<bool>& solid) {
  std::vector<uint32_t> distance(grid.voxels, UINT32_MAX);
  forEachPair(grid, solid, [&](uint32_t i, const glm::uvec3& d) {
    distance[i] = std::min(distance[i], d.x * d.x + d.y * d.y + d.z * d.z);
  });
  return distance;
}

}  // namespace irad::oracle
