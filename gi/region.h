// The part of a scene that has voxels (scene.region, docs/method.md 2).
#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <string>
#include <vector>

#include "renderer/scene/scene.h"

namespace irad {

struct Settings;

struct SceneRegion {
  glm::vec3 lo{0}, hi{0};  ///< local; the scene's bounds where it is the whole
  bool whole = true;
  /// What is said of it: what is left out; where scene.region=auto found a part that holds the detail and takes the
  /// whole all the same, why. Else nothing.
  std::string line;
  bool operator==(const SceneRegion&) const = default;
};

/// What the settings ask for, within the scene's bounds. UsageError, with the setting and its value, where that holds
/// nothing of the scene.
SceneRegion regionOf(const Scene& scene, const Settings& settings);
/// The same, but the whole where the settings are wrong.
SceneRegion regionOrWhole(const Scene& scene, const Settings& settings);
/// With the box that the scene brings along, where scene.region=auto takes it, as scene.region=box: the settings that
/// say the same of a scene without.
Settings withRegionOf(const Scene& scene, const Settings& settings);

/// Triangles with a part outside the region, ascending.
std::vector<uint32_t> trianglesOutside(const Geometry& geometry, const SceneRegion& region);

/// What is left out, in a line; empty where nothing is. World coordinates.
std::string describe(const Scene& scene, const SceneRegion& region);

}  // namespace irad
