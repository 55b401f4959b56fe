// Where to stand in a scene that has no camera and is seen from within.
#pragma once

#include <glm/glm.hpp>
#include <optional>

namespace irad {

struct Scene;

struct Viewpoint {
  glm::dvec3 position{0.0};            ///< local
  glm::dvec3 forward{0.0, 0.0, -1.0};  ///< unit, horizontal
  double clearance = 0;                ///< to the nearest wall at its height, about
  double facing = 0;                   ///< share of all surface, by area, that has other surface straight before it
};
/// Where more than half of the surface faces inwards, that is, has other surface straight before it: the place with the
/// most room, the longest view and the most that is lit among those that surfaces' fronts are around on nearly all
/// sides; none where there is none, as on a plane. Light: emitters, lamps, suns and what is open. Looks at every
/// triangle; some tenths of a second at most.
std::optional<Viewpoint> viewpointInside(const Scene& scene);

}  // namespace irad
