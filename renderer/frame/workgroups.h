// How many workgroups a dispatch takes: pure functions of the work and of the shader's workgroup size.
#pragma once

#include <array>
#include <cstdint>
#include <glm/glm.hpp>

namespace irad {

/// `count` workgroups, in x up to `limit`, then in as few rows as will do, the last of which may have some too many.
glm::uvec3 foldedWorkgroups(uint64_t count, uint32_t limit);
/// At least `invocations`, in one dimension, folded likewise.
glm::uvec3 workgroupsFor(uint64_t invocations, const std::array<uint32_t, 3>& localSize, uint32_t limit);
/// At least `invocations.x` by `invocations.y`. A workgroup of n x 1 x 1 counts as sqrt(n) x sqrt(n).
glm::uvec3 workgroupsFor(glm::uvec2 invocations, const std::array<uint32_t, 3>& localSize);

}  // namespace irad
