#include "gi/sizes.h"

#include <algorithm>

namespace irad {

bool lowerSizes(Settings& settings) {
  uint32_t& rays = settings.matrix.gpu.rays;
  uint32_t& resolution = settings.voxel.resolution;
  if (rays > 128) {
    rays = std::max(128u, rays - 128);
    return true;
  }
  if (resolution > 64) {
    resolution = std::max(64u, resolution * 3 / 4);
    return true;
  }
  return false;
}

}  // namespace irad
