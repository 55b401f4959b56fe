// Puts buildings together as artists do: blocks that run into each other, panes that overlap their openings, columns
// through slabs. What is random comes from a seed. Lengths are metres, the building's y is up; it is turned at the end.
#pragma once

#include <array>
#include <glm/glm.hpp>
#include <optional>
#include <string>
#include <vector>

#include "gi/check/path_surfaces.h"
#include "gi/check/scenes.h"

namespace irad {

/// A convex part of space: the points p with plane.xyz . p < plane.w for all planes.
struct Room {
  std::vector<glm::dvec4> planes;
  bool contains(const glm::dvec3& p) const;
  /// Between two corners.
  static Room between(const glm::dvec3& lo, const glm::dvec3& hi);
};

/// An opening in a wall: from, to along it, lower and upper edge.
struct Opening {
  double from = 0, to = 0, low = 0, high = 0;
};

class Mason {
 public:
  /// `voxel`: edge of a voxel of the grid that the building will be judged at.
  Mason(uint64_t seed, uint64_t family, double voxel) : voxel(voxel), random_(seed, family) {}
  const double voxel;

  // ---- What the seed decides ----
  double between(double lo, double hi) { return lo + (hi - lo) * random_.next(); }
  /// One of lo, lo + 1, ..., hi.
  int whole(int lo, int hi) { return lo + static_cast<int>(random_.next() * (hi - lo + 1)); }
  bool chance(double p) { return random_.next() < p; }
  /// From `lo` to `hi` voxels, small ones as often as large ones; metres.
  double thickness(double lo = 0.2, double hi = 3);
  /// A Lambertian colour, channels .3 to .8; it emits the exitance, W/m^2.
  uint32_t paint(double exitance = 0, bool doubleSided = false);

  // ---- Parts: closed, faces outwards ----
  void block(uint32_t material, const glm::dvec3& lo, const glm::dvec3& hi);
  /// A board from one edge's middle to the other's: `wide` along `across` (unit), `thick` across both.
  void board(uint32_t material, const glm::dvec3& from, const glm::dvec3& to, const glm::dvec3& across, double wide,
             double thick);
  /// A lamp of 2 `wide` x 2 `deep` at height `y`, its middle at x, 0, that shines downwards.
  void lamp(uint32_t material, double x, double y, double wide, double deep);
  /// An upright column with `sides` faces, an even number.
  void column(uint32_t material, double x, double z, double radius, double low, double high, int sides);
  /// A wall across axis 0 or 2, from `at` to `at` + `thick`, along the other from `from` to `to`. Beside an opening the
  /// blocks are a twentieth thinner on both sides and run into those above and below.
  void wall(uint32_t material, int axis, double at, double thick, double from, double to, double low, double high,
            const std::optional<Opening>& opening = std::nullopt);
  /// A pane in the middle of such a wall's thickness, that runs into the wall all around.
  void pane(uint32_t material, int axis, double at, double thick, const Opening& opening, double paneThick);
  /// Floor, ceiling and four walls around the inside `lo` to `hi`, each `thick`; walls run past each other at the
  /// corners, and into floor and ceiling. Openings: of the walls at -x +x -z +z.
  void shell(uint32_t floor, uint32_t walls, const glm::dvec3& lo, const glm::dvec3& hi, double thick,
             const std::array<std::optional<Opening>, 4>& openings = {});

  SceneBuilder builder;
  /// The scene, turned: a third each upright, about y, and about any axis; `rooms` and cameras with it. All materials
  /// are Lambertian. How it is turned is drawn here.
  Scene finish(std::string name, std::vector<Room>& rooms);

 private:
  truth::Random random_;
};

}  // namespace irad
