#include "renderer/scene/first_surface.h"

#include <array>
#include <limits>

#include "renderer/scene/scene.h"

namespace irad {

std::optional<SurfacePoint> firstSurface(const Scene& scene, const glm::dvec3& from, const glm::dvec3& direction) {
  const glm::dvec3 start = from - scene.origin;
  std::optional<SurfacePoint> first;
  double least = std::numeric_limits<double>::infinity();
  for (const Draw& draw : scene.draws) {
    const bool bothSides = scene.materials.at(draw.material).doubleSided;
    for (uint32_t index = draw.firstIndex; index < draw.firstIndex + draw.indexCount; index += 3) {
      std::array<glm::dvec3, 3> corner;
      for (uint32_t i = 0; i < 3; ++i) corner[i] = glm::dvec3(scene.positions[scene.indices[index + i]]);
      const glm::dvec3 facing = glm::cross(corner[1] - corner[0], corner[2] - corner[0]);
      const double towards = glm::dot(facing, direction);
      if (towards == 0 || (!bothSides && towards > 0)) continue;
      const double t = glm::dot(facing, corner[0] - start) / towards;
      if (!(t > 0 && t < least)) continue;
      const glm::dvec3 at = start + t * direction;
      bool inside = true;
      for (size_t i = 0; i < 3; ++i)
        inside = inside && glm::dot(glm::cross(corner[(i + 1) % 3] - corner[i], at - corner[i]), facing) >= 0;
      if (!inside) continue;
      least = t;
      first = {at + scene.origin, glm::normalize(towards > 0 ? -facing : facing), index / 3};
    }
  }
  return first;
}

}  // namespace irad
