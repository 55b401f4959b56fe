// Where to stand in a scene that has no camera and is seen from within.
#pragma once

#include <glm/glm.hpp>
#include <optional>

namespace irad {

struct Scene;

/// Of all surface, by area: what faces the centre of the bounds, 0..1.
double shareFacingInwards(const Scene& scene);

struct Viewpoint {
  glm::dvec3 position{0.0};            ///< local
  glm::dvec3 forward{0.0, 0.0, -1.0};  ///< unit, horizontal
  double clearance = 0;                ///< to the nearest wall at its height, about
};
/// The place with the longest view among those that surfaces are around on nearly all sides; none where there is none:
/// before an open stage, on a plane. Looks at every triangle; some tenths of a second at most.
std::optional<Viewpoint> viewpointInside(const Scene& scene);

}  // namespace irad
