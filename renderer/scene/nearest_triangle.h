// Which triangle of a scene a point that was seen lies on.
#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <optional>
#include <vector>

namespace irad {

struct Scene;

/// Triangles in blocks with bounds, so that most need no look: some ten microseconds for a point of a scene of a
/// quarter of a million. Of the scene's geometry as it was when this was made.
class TriangleFinder {
 public:
  explicit TriangleFinder(const Scene& scene);
  /// The triangle nearest to `point` (world) of those that show a side towards `normal`; none in a scene without such.
  /// `scene`: the same.
  std::optional<uint32_t> nearest(const Scene& scene, const glm::dvec3& point, const glm::dvec3& normal) const;

 private:
  struct Block {
    glm::vec3 low, high;  ///< local
    uint32_t firstIndex, endIndex, material;
  };
  std::vector<Block> blocks_;
};

/// The same once.
std::optional<uint32_t> nearestTriangle(const Scene& scene, const glm::dvec3& point, const glm::dvec3& normal);
/// The material of a triangle of the scene.
uint32_t materialOf(const Scene& scene, uint32_t triangle);

}  // namespace irad
