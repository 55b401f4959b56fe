#include "ui/new_light.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "renderer/scene/first_surface.h"

namespace irad {
namespace {

struct Stretch {
  double from, to;
};

/// What of a ray is in a box: empty where `from` > `to`.
Stretch inside(const glm::dvec3& low, const glm::dvec3& high, const glm::dvec3& start, const glm::dvec3& direction) {
  Stretch s{0, std::numeric_limits<double>::infinity()};
  for (int axis = 0; axis < 3; ++axis) {
    if (direction[axis] == 0) {
      if (start[axis] < low[axis] || start[axis] > high[axis]) return {1, 0};
      continue;
    }
    const double a = (low[axis] - start[axis]) / direction[axis], b = (high[axis] - start[axis]) / direction[axis];
    s = {std::max(s.from, std::min(a, b)), std::min(s.to, std::max(a, b))};
  }
  return s;
}

}  // namespace

Light newLight(const LightKind& kind, const Scene& scene, const Camera& camera) {
  const glm::dvec3 low = scene.origin + glm::dvec3(scene.boundsMin), high = scene.origin + glm::dvec3(scene.boundsMax);
  const double diagonal = std::max(glm::distance(low, high), 1e-6);
  const glm::dvec3 forward = glm::normalize(glm::dvec3(camera.orientation * glm::vec3(0, 0, -1)));
  double distance = 0.25 * diagonal;  // to what it lights
  Light light;
  light.type = kind.type;
  light.name = kind.name;
  light.direction = glm::vec3(forward);
  light.position = 0.5 * (low + high);
  if (const Stretch s = inside(low, high, camera.position, forward); s.from < s.to) {
    const auto surface = firstSurface(scene, camera.position + s.from * forward, forward);
    const double end = surface ? glm::dot(surface->position - camera.position, forward) : s.to;
    // A surface that is the scene's outside has no room before it within the bounds.
    distance = std::max(0.5 * (end - s.from), (s.from > 0 ? 0.02 : 1e-4) * diagonal);
    light.position = camera.position + (end - distance) * forward;
  }
  const double intensity = std::numbers::pi * (kind.has(LIGHT_DISTANT) ? 1 : distance * distance);
  light.intensity = static_cast<float>(std::clamp(intensity, 1e-6, kMaxLightOrEmission));
  if (kind.has(LIGHT_CONE)) light.outerCos = std::cos(std::numbers::pi_v<float> / 6);
  return light;
}

}  // namespace irad
