#include "gi/thesis/literal_grid.h"

#include <algorithm>
#include <cmath>

#include "gi/grid.h"

namespace irad {

Grid makeLiteralGrid(glm::vec3 boundsMin, glm::vec3 boundsMax, uint32_t resolution) {
  checkGridInput(boundsMin, boundsMax, resolution, kLargestAxis);
  const glm::dvec3 extent = glm::dvec3(boundsMax) - glm::dvec3(boundsMin);
  const double largest = std::max({extent.x, extent.y, extent.z});
  Grid grid{};
  grid.edge = largest > 0 ? static_cast<float>(largest / resolution) : 1.0f;
  // An axis that T eq. 5 leaves without voxels keeps one, since a volume cannot be empty.
  for (int a = 0; a < 3; ++a)
    grid.dims[a] = largest > 0 ? std::max(1u, static_cast<uint32_t>(std::floor(resolution * extent[a] / largest))) : 1u;
  grid.origin = boundsMin;
  return finishedGrid(grid);
}

}  // namespace irad
