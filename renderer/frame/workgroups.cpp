#include "renderer/frame/workgroups.h"

#include <algorithm>
#include <cmath>

#include "renderer/base/error.h"

namespace irad {

glm::uvec3 foldedWorkgroups(uint64_t count, uint32_t limit) {
  const uint64_t rows = std::max<uint64_t>(1, (count + limit - 1) / limit);
  return {(count + rows - 1) / rows, rows, 1};
}

glm::uvec3 workgroupsFor(uint64_t invocations, const std::array<uint32_t, 3>& localSize, uint32_t limit) {
  IRAD_CHECK(localSize[1] == 1 && localSize[2] == 1, "{} invocations for workgroups of {} x {} x {}", invocations,
             localSize[0], localSize[1], localSize[2]);
  IRAD_CHECK_OP(invocations, <=, uint64_t{UINT32_MAX});  // irad_index() is a uint
  return foldedWorkgroups((invocations + localSize[0] - 1) / localSize[0], limit);
}

glm::uvec3 workgroupsFor(glm::uvec2 invocations, const std::array<uint32_t, 3>& localSize) {
  glm::uvec2 tile{localSize[0], localSize[1]};
  if (tile.y == 1) tile = glm::uvec2(static_cast<uint32_t>(std::lround(std::sqrt(tile.x))));
  IRAD_CHECK(tile.x * tile.y == localSize[0] * localSize[1] && localSize[2] == 1,
             "{} x {} invocations for workgroups of {} x {} x {}", invocations.x, invocations.y, localSize[0],
             localSize[1], localSize[2]);
  return {(invocations + tile - 1u) / tile, 1};
}

}  // namespace irad
