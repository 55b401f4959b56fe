#include "gi/compare.h"

#include <algorithm>
#include <unordered_set>
#include <vector>

#include "gi/export.h"

namespace irad {

VoxelMetrics compareVoxels(const VolumeValues& values, const VolumeValues& reference) {
  const auto at = [](const VolumeValues& volume, uint32_t voxel) {
    const float* v = &volume.values[size_t{3} * voxel];
    return glm::vec4(v[0], v[1], v[2], 1);
  };
  VoxelMetrics result;
  std::vector<glm::vec4> matched, matchedReference;
  std::unordered_set<uint32_t> used;
  const Grid &vg = values.grid, &rg = reference.grid;
  for (uint32_t z = 0, index = 0; z < rg.dims.z; ++z)
    for (uint32_t y = 0; y < rg.dims.y; ++y)
      for (uint32_t x = 0; x < rg.dims.x; ++x, ++index) {
        if (!reference.solid[index]) continue;
        const glm::vec3 centre = rg.origin + (glm::vec3(x, y, z) + 0.5f) * rg.edge;
        const glm::vec3 cell = glm::floor((centre - vg.origin) * vg.inverseEdge);
        const bool inside =
            glm::all(glm::greaterThanEqual(cell, glm::vec3(0))) && glm::all(glm::lessThan(cell, glm::vec3(vg.dims)));
        const uint32_t other = inside ? voxelIndex(glm::uvec3(cell), vg.dims) : 0;
        if (!inside || !values.solid[other]) {
          ++result.onlyReference;
          continue;
        }
        used.insert(other);
        matched.push_back(at(values, other));
        matchedReference.push_back(at(reference, index));
      }
  result.irradiance = measure(matched, matchedReference);
  const auto solid = std::count(values.solid.begin(), values.solid.end(), true);
  result.onlyValues = static_cast<size_t>(solid) - used.size();
  return result;
}

}  // namespace irad
