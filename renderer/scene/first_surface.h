// Which surface a ray through a scene meets.
#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <optional>

namespace irad {

struct Scene;

struct SurfacePoint {
  glm::dvec3 position{0.0};  ///< world
  glm::dvec3 normal{0.0};    ///< unit, the triangle's own, towards where the ray came from
  uint32_t triangle = 0;
};
/// Where a ray (world; any length of `direction` but 0) first meets a triangle, ahead of `from`, as pictures show them:
/// backs of one-sided ones let it pass; the holes of an alpha mask do not. Looks at every triangle: some milliseconds
/// for a quarter of a million.
std::optional<SurfacePoint> firstSurface(const Scene& scene, const glm::dvec3& from, const glm::dvec3& direction);

}  // namespace irad
