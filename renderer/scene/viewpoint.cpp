// Where to stand in a scene that has no camera and is seen from within: a room, a church, a cave.
#include "renderer/scene/viewpoint.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "renderer/scene/scene.h"

namespace irad {
namespace {

constexpr int kCellsAcross = 40;  ///< along the longest extent

/// The directions to the 26 cells around one, and those between them in the horizontal plane.
constexpr std::array<std::array<int, 2>, 16> kHeadings{{{0, -1},
                                                        {1, -2},
                                                        {1, -1},
                                                        {2, -1},
                                                        {1, 0},
                                                        {2, 1},
                                                        {1, 1},
                                                        {1, 2},
                                                        {0, 1},
                                                        {-1, 2},
                                                        {-1, 1},
                                                        {-2, 1},
                                                        {-1, 0},
                                                        {-2, -1},
                                                        {-1, -1},
                                                        {-1, -2}}};

/// Cells of one edge length over the bounds; those that a triangle may touch are solid.
struct SolidCells {
  glm::ivec3 dims{1};
  double edge = 0;
  std::vector<bool> solid;
  /// What the triangles in a cell face: their areas, a cell's side at most, along +x, +y, +z, -x, -y, -z.
  std::vector<std::array<float, 6>> facing;
  std::vector<bool> lit;  ///< emits, or is free and sees a light

  size_t at(const glm::ivec3& c) const {
    return static_cast<size_t>(c.x) +
           static_cast<size_t>(dims.x) *
               (static_cast<size_t>(c.y) + static_cast<size_t>(dims.y) * static_cast<size_t>(c.z));
  }
  bool inside(const glm::ivec3& c) const {
    return glm::all(glm::greaterThanEqual(c, glm::ivec3(0))) && glm::all(glm::lessThan(c, dims));
  }
  /// Whether a solid cell, seen along a direction, shows fronts rather than backs. Backs are seen by who stands within
  /// a wall. Faces count by their winding, double-sided or not: those of a wall are drawn to be seen from its room.
  bool showsFronts(const glm::ivec3& c, const glm::ivec3& along) const {
    const auto& areas = facing[at(c)];
    float fronts = 0, backs = 0;
    for (int axis = 0; axis < 3; ++axis) {
      const float share = static_cast<float>(std::abs(along[axis]));
      const size_t with = static_cast<size_t>(along[axis] > 0 ? axis : axis + 3), against = (with + 3) % 6;
      fronts += share * areas[against], backs += share * areas[with];
    }
    return fronts >= 0.5f * backs;
  }
};

struct Corners {
  glm::dvec3 a, b, c;
  glm::dvec3 cross() const { return glm::cross(b - a, c - a); }  ///< its normal, twice its area long
};

Corners cornersOf(const Scene& scene, size_t t) {
  const auto corner = [&](size_t k) { return glm::dvec3(scene.positions[scene.indices[3 * t + k]]); };
  return {corner(0), corner(1), corner(2)};
}

/// By its bounds and its plane: a little more than it touches.
void markSolid(SolidCells& cells, const Scene& scene, const Corners& t, bool emits) {
  const glm::dvec3 lo(scene.boundsMin), n = t.cross();
  const auto cellOf = [&](const glm::dvec3& p) {
    return glm::clamp(glm::ivec3(glm::floor((p - lo) / cells.edge)), glm::ivec3(0), cells.dims - 1);
  };
  const glm::ivec3 first = cellOf(glm::min(t.a, glm::min(t.b, t.c))), last = cellOf(glm::max(t.a, glm::max(t.b, t.c)));
  const double reach = 0.5 * cells.edge * (std::abs(n.x) + std::abs(n.y) + std::abs(n.z));
  const double twiceArea = glm::length(n), area = std::min(twiceArea / 2, cells.edge * cells.edge);
  std::array<float, 6> facing{};
  for (int axis = 0; axis < 3 && twiceArea > 0; ++axis)
    facing[static_cast<size_t>(n[axis] > 0 ? axis : axis + 3)] =
        static_cast<float>(area * std::abs(n[axis]) / twiceArea);
  for (int z = first.z; z <= last.z; ++z)
    for (int y = first.y; y <= last.y; ++y)
      for (int x = first.x; x <= last.x; ++x) {
        const glm::dvec3 centre = lo + cells.edge * (glm::dvec3(x, y, z) + 0.5);
        if (std::abs(glm::dot(n, centre - t.a)) > reach * (1 + 1e-9)) continue;
        const size_t cell = cells.at({x, y, z});
        cells.solid[cell] = true;
        if (emits) cells.lit[cell] = true;
        for (size_t side = 0; side < facing.size(); ++side) cells.facing[cell][side] += facing[side];
      }
}

struct Sight {
  double far = -1;     ///< cells to a surface; less than 0: out of the bounds, or to the back of something
  bool light = false;  ///< what is seen is lit, or outside
};
/// What one sees from a cell along a direction of whole cells.
Sight look(const SolidCells& cells, const glm::ivec3& from, const glm::ivec3& direction) {
  const int steps = std::max({std::abs(direction.x), std::abs(direction.y), std::abs(direction.z)});
  const double length = glm::length(glm::dvec3(direction)) / steps;
  glm::ivec3 before = from;
  for (int i = 1;; ++i) {
    // Nearest cell, away from 0 in the middle: the same to both sides.
    const auto along = [&](int d) { return (2 * std::abs(d) * i + steps) / (2 * steps) * (d < 0 ? -1 : 1); };
    const glm::ivec3 at = from + glm::ivec3(along(direction.x), along(direction.y), along(direction.z));
    if (!cells.inside(at)) return {.light = true};
    if (cells.solid[cells.at(at)])
      return {cells.showsFronts(at, direction) ? (i - 1) * length : -1,
              cells.lit[cells.at(at)] || cells.lit[cells.at(before)]};
    before = at;
  }
}

/// Whether nothing solid is on the way from a cell's middle, in units of cells, to the end or out of the bounds.
bool free(const SolidCells& cells, const glm::dvec3& from, const glm::dvec3& way) {
  const int steps = static_cast<int>(std::ceil(2 * glm::length(way)));
  for (int i = 1; i < steps; ++i) {
    const glm::ivec3 at(glm::floor(from + way * (static_cast<double>(i) / steps)));
    if (!cells.inside(at)) return true;
    if (cells.solid[cells.at(at)]) return false;
  }
  return true;
}

/// Emitters by their materials; free cells by suns and lamps that they see, whatever their range and cone.
void markLit(SolidCells& cells, const Scene& scene) {
  constexpr size_t kMostLights = 32;
  const double across = glm::length(glm::dvec3(cells.dims));
  for (int z = 0; z < cells.dims.z; ++z)
    for (int y = 0; y < cells.dims.y; ++y)
      for (int x = 0; x < cells.dims.x; ++x) {
        const size_t cell = cells.at({x, y, z});
        if (cells.solid[cell]) continue;
        const glm::dvec3 here = glm::dvec3(x, y, z) + 0.5;
        for (size_t i = 0; i < std::min(scene.lights.size(), kMostLights) && !cells.lit[cell]; ++i) {
          const Light& light = scene.lights[i];
          const glm::dvec3 lamp = (light.position - scene.origin - glm::dvec3(scene.boundsMin)) / cells.edge;
          cells.lit[cell] =
              free(cells, here, light.type == LightType::Sun ? -across * glm::dvec3(light.direction) : lamp - here);
        }
      }
}

/// What is to be seen from a cell; nothing where it is not enclosed.
struct Stand {
  double score = 0, clearance = 0;  ///< clearance: to the nearest wall, in cells
  std::array<int, 2> heading{};
};
Stand lookAround(const SolidCells& cells, const glm::ivec3& from) {
  constexpr double kRoom = kCellsAcross / 5.0;  // as far as this is room; a corridor has it to two sides
  constexpr int kNeeded = 20;                   // of 26: an open side, which 9 of them leave by, is too much
  constexpr double kDark = 0.02;                // what a place counts from which nothing lit is seen
  int met = 0, light = 0;
  for (int z = -1; z <= 1; ++z)
    for (int y = -1; y <= 1; ++y)
      for (int x = -1; x <= 1; ++x) {
        if (x == 0 && y == 0 && z == 0) continue;
        const Sight sight = look(cells, from, {x, y, z});
        met += sight.far >= 0, light += sight.light;
      }
  if (met < kNeeded) return {};
  Stand out{.clearance = kCellsAcross};
  double farthest = 0, room = 0;
  for (const auto& heading : kHeadings) {
    const Sight sight = look(cells, from, {heading[0], 0, heading[1]});
    light += sight.light;
    if (sight.far < 0) continue;
    room += std::min(sight.far, kRoom);
    out.clearance = std::min(out.clearance, sight.far);
    if (sight.far > farthest) farthest = sight.far, out.heading = heading;
  }
  const double below = look(cells, from, {0, -1, 0}).far, roof = look(cells, from, {0, 1, 0}).far;
  const double above = roof < 0 ? cells.dims.y - 1 - from.y : roof;  // or up to the open top
  if (below < 0 || farthest < 2) return {};
  // A long view, but rather room to all sides, not from against a wall, from where eyes are, two fifths of the way up,
  // and of something that light falls on.
  const double height = (below + 0.5) / (below + above + 1);
  out.score = std::sqrt(farthest) * room * std::min(1.0, (out.clearance + 0.5) / 2) * (1 - std::abs(height - 0.4)) *
              (kDark + light / (26.0 + kHeadings.size()));
  return out;
}

/// Of all surface, by area, what has other surface before it, straight ahead from the middle of each triangle.
double shareFacingInwards(const SolidCells& cells, const Scene& scene) {
  constexpr size_t kMost = 500'000;  // triangles that are looked at
  const size_t stride = 1 + scene.triangleCount() / kMost;
  double all = 0, inwards = 0;
  for (size_t t = 0; t < scene.triangleCount(); t += stride) {
    const Corners c = cornersOf(scene, t);
    const glm::dvec3 cross = c.cross();
    const double area = glm::length(cross);
    if (!(area > 0)) continue;
    all += area;
    const glm::dvec3 ahead = cross / area;
    const glm::dvec3 from = ((c.a + c.b + c.c) / 3.0 - glm::dvec3(scene.boundsMin)) / cells.edge;
    for (double far = 1.5;; far += 0.5) {  // cells; its own is solid
      const glm::ivec3 at(glm::floor(from + far * ahead));
      if (!cells.inside(at)) break;
      if (!cells.solid[cells.at(at)]) continue;
      inwards += area;
      break;
    }
  }
  return all > 0 ? inwards / all : 0;
}

}  // namespace

std::optional<Viewpoint> viewpointInside(const Scene& scene) {
  const glm::dvec3 extent(scene.boundsMax - scene.boundsMin);
  const double longest = std::max({extent.x, extent.y, extent.z});
  if (!(longest > 0)) return std::nullopt;
  SolidCells cells;
  cells.edge = longest / kCellsAcross;
  cells.dims = glm::max(glm::ivec3(glm::ceil(extent / cells.edge - 1e-9)), glm::ivec3(1));
  const size_t count =
      static_cast<size_t>(cells.dims.x) * static_cast<size_t>(cells.dims.y) * static_cast<size_t>(cells.dims.z);
  cells.solid.assign(count, false);
  cells.facing.assign(count, {});
  cells.lit.assign(count, false);
  for (const Draw& draw : scene.draws) {
    const bool emits = scene.materials[draw.material].emission != glm::vec3(0);
    for (size_t t = draw.firstIndex / 3; t < (draw.firstIndex + draw.indexCount) / 3; ++t)
      markSolid(cells, scene, cornersOf(scene, t), emits);
  }
  markLit(cells, scene);
  Viewpoint out;
  out.facing = shareFacingInwards(cells, scene);
  if (out.facing <= 0.5) return std::nullopt;
  Stand best;
  glm::ivec3 where(0);
  for (int z = 0; z < cells.dims.z; ++z)
    for (int y = 0; y < cells.dims.y; ++y)
      for (int x = 0; x < cells.dims.x; ++x) {
        if (cells.solid[cells.at({x, y, z})]) continue;
        const Stand stand = lookAround(cells, {x, y, z});
        if (stand.score > best.score) best = stand, where = {x, y, z};
      }
  if (best.score == 0) return std::nullopt;
  out.position = glm::dvec3(scene.boundsMin) + cells.edge * (glm::dvec3(where) + 0.5);
  out.forward = glm::normalize(glm::dvec3(best.heading[0], 0, best.heading[1]));
  out.clearance = cells.edge * (best.clearance + 0.5);
  return out;
}

}  // namespace irad
