// What lies outside the region that has voxels (docs/method.md 4): rays that leave the grid meet its triangles.
#pragma once

#include <glm/glm.hpp>
#include <map>
#include <vector>

#include "gi/emitters.h"
#include "renderer/resources.h"
#include "shaders/shared/outer.h"

namespace irad {

class Context;
class Frame;
class SceneOnDevice;
struct FacetList;
struct Field;
struct Grid;
struct SceneRegion;
struct SkyOnDevice;

/// Empty where nothing lies outside.
struct Outer {
  Buffer nodes, order, lattice, points, albedo, exitance, irradiance, bins;  ///< of OuterArrays
  Buffer record;                                                             ///< one OuterArrays
  uint32_t count = 0;                                                        ///< points
  std::vector<OuterLattice> lattices;                                        ///< `lattice`
  std::vector<uint32_t> triangles;  ///< outside, and for each its area, of both sides that show, voxels^2
  std::vector<float> areas;
  Emitters emitters;               ///< of `triangles`
  std::map<int, glm::vec3> means;  ///< linear, of images that were looked at, by index
  explicit operator bool() const { return static_cast<bool>(record); }
};

/// `repeated`: triangles that rays do not meet (gi/repeated.h). UsageError where more lies outside than bins can tell
/// apart.
Outer makeOuter(Context& context, const SceneOnDevice& scene, const SceneRegion& region, const Grid& grid,
                const std::vector<uint32_t>& repeated);
/// Albedo and exitance by the scene's materials as they are.
void shadeOuter(Context& context, const SceneOnDevice& scene, Outer& outer);
/// The light of the points (nothing without any), after which `bins` holds the sky's and theirs. `emitters`: the
/// facets'. `sky`: may have none.
void lightOuter(Frame& frame, const SceneOnDevice& scene, const FacetList& facets, const Emitters& emitters,
                const Field& field, const SkyOnDevice& sky);
/// What rays that leave the grid may meet: the sky's bins, and the points behind them where something lies outside.
/// Empty: nothing.
const Buffer& binsOf(const Outer& outer, const SkyOnDevice& sky);

// ---- For tests ----

/// The tree over boxes of triangles in voxel units, three corners each: which of these, in the order of leaves, in
/// `order`.
std::vector<OuterNode> outerTree(const std::vector<glm::vec3>& corners, std::vector<uint32_t>& order);

}  // namespace irad
