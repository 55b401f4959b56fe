// What a list of facets takes of a scene's geometry whatever its resolution: looked for once, since every triangle is
// looked at.
#pragma once

#include <vector>

#include "gi/region.h"
#include "gi/repeated.h"

namespace irad {

struct SceneShape {
  SceneRegion region;  ///< that has voxels
  std::vector<SamePlace> samePlaces;
};
/// UsageError as regionOf() has it.
inline SceneShape shapeOf(const Scene& scene, const Settings& settings) {
  return {regionOf(scene, settings), samePlaces(scene)};
}

}  // namespace irad
