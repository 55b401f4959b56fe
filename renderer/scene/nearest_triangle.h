// Which triangle of a scene a point that was seen lies on.
#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <optional>

namespace irad {

struct Scene;

/// The triangle nearest to `point` (world) of those that show a side towards `normal`; none in a scene without such.
/// Looks at every triangle.
std::optional<uint32_t> nearestTriangle(const Scene& scene, const glm::dvec3& point, const glm::dvec3& normal);
/// The material of a triangle of the scene.
uint32_t materialOf(const Scene& scene, uint32_t triangle);

}  // namespace irad
