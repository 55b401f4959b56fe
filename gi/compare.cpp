#include "gi/compare.h"

#include <unordered_set>
#include <vector>

namespace irad {
namespace {

/// Per voxel of the grid: mean H of its facets, w 1; w 0 where it is empty.
std::vector<glm::vec4> voxelIrradiance(Context& context, const FacetList& facets, const Lighting& light) {
  std::vector<glm::vec4> out(facets.grid.voxels, glm::vec4(0));
  if (facets.count == 0) return out;
  const auto reverse = downloadAs<uint32_t>(context, facets.reverse);
  const auto h = downloadAs<glm::vec4>(context, light.indirect);
  for (size_t v = 0; v < out.size(); ++v) {
    if (reverse[v] == NO_FACET) continue;
    const uint32_t first = reverse[v] & ~SECOND_FACET;
    const glm::vec3 one(h[first]);
    out[v] = glm::vec4((reverse[v] & SECOND_FACET) != 0 ? 0.5f * (one + glm::vec3(h[first + 1])) : one, 1);
  }
  return out;
}

}  // namespace

VoxelMetrics compareVoxels(Context& context, const FacetList& values, const Lighting& valuesLight,
                           const FacetList& reference, const Lighting& referenceLight) {
  const std::vector<glm::vec4> v = voxelIrradiance(context, values, valuesLight);
  const std::vector<glm::vec4> r = voxelIrradiance(context, reference, referenceLight);
  VoxelMetrics result;
  std::vector<glm::vec4> matched, matchedReference;
  std::unordered_set<uint32_t> used;
  const Grid &vg = values.grid, &rg = reference.grid;
  for (uint32_t z = 0, index = 0; z < rg.dims.z; ++z)
    for (uint32_t y = 0; y < rg.dims.y; ++y)
      for (uint32_t x = 0; x < rg.dims.x; ++x, ++index) {
        if (r[index].w == 0) continue;
        const glm::vec3 centre = rg.origin + (glm::vec3(x, y, z) + 0.5f) * rg.edge;
        const glm::vec3 cell = glm::floor((centre - vg.origin) * vg.inverseEdge);
        const bool inside =
            glm::all(glm::greaterThanEqual(cell, glm::vec3(0))) && glm::all(glm::lessThan(cell, glm::vec3(vg.dims)));
        const uint32_t other = inside ? voxelIndex(glm::uvec3(cell), vg.dims) : 0;
        if (!inside || v[other].w == 0) {
          ++result.onlyReference;
          continue;
        }
        used.insert(other);
        matched.push_back(v[other]);
        matchedReference.push_back(r[index]);
      }
  result.irradiance = measure(matched, matchedReference);
  result.onlyValues = values.solidVoxels - used.size();
  return result;
}

}  // namespace irad
