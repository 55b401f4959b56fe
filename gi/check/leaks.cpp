// Thin walls: a row of rooms, dark and lit in turn, with walls of 0 to 3 voxels between them at several phases of the
// grid. No light may come through, neither by rays nor by the filters that shading samples with.
#include <fmt/format.h>

#include <algorithm>
#include <array>

#include "gi/check/cases.h"
#include "gi/check/scenes.h"
#include "gi/lighting.h"

namespace irad {
namespace {

constexpr float kLength = 64, kWidth = 16;  ///< of the row, voxels at N = 64
constexpr float kThickness[] = {0, 0.25f, 0.5f, 1, 1.5f, 2, 3};
/// Where walls begin: phases 0, .3, .5 and .9, near enough to even spacing.
constexpr std::array<float, 4> kWalls{-20, -6.7f, 6.5f, 18.9f};

/// The rooms at both ends and in the middle are dark; in the two others a lamp below the ceiling and a point light
/// shine.
Scene rowOfRooms(float thickness) {
  SceneBuilder b;
  const glm::vec3 half = 0.5f * glm::vec3(kLength, kWidth, kWidth);
  const uint32_t m = b.material(glm::vec3(0.5f)), lamp = b.material(glm::vec3(0.5f), glm::vec3(1.0f));
  b.box({m, m, m, m, m, m}, -half, half, /*inward=*/true);
  const float y = half.y, z = half.z;
  for (const float left : kWalls) {
    const float right = left + thickness;
    b.quad(m, {left, -y, z}, {left, y, z}, {left, y, -z}, {left, -y, -z});      // faces -x
    b.quad(m, {right, -y, -z}, {right, y, -z}, {right, y, z}, {right, -y, z});  // faces +x
  }
  for (const size_t first : {size_t{0}, size_t{2}}) {
    const float x = 0.5f * (kWalls[first] + thickness + kWalls[first + 1]), below = y - 0.25f;
    b.quad(lamp, {x - 2, below, -2}, {x + 2, below, -2}, {x + 2, below, 2}, {x - 2, below, 2});
    b.point(glm::dvec3(x, 0, 3), 30);
  }
  // From the dark rooms, towards the foot of each wall.
  for (size_t i = 0; i < kWalls.size(); ++i) {
    const bool litBehind = i % 2 == 0;  // the lit room is on its +x side
    const double wall = litBehind ? kWalls[i] : kWalls[i] + thickness;
    b.camera({wall + (litBehind ? -10 : 10), 0.3 * kWidth, 0.2 * kWidth}, {wall, -0.4 * kWidth, 0});
  }
  return b.finish("row of rooms");
}

enum class Side { lit, dark, hidden };
/// Which kind of room a facet belongs to; hidden: it lies inside a wall.
Side sideOf(float thickness, const glm::dvec3& position, const glm::dvec3& normal) {
  const double x = position.x + 0.1 * normal.x;  // in front of a wall's face
  int room = 0;
  for (const float left : kWalls) {
    if (x > left && x < left + thickness) return Side::hidden;
    room += x > left;
  }
  return room % 2 == 1 ? Side::lit : Side::dark;
}

struct Sides {
  double lit = 0;    ///< mean over the lit rooms
  double dark = 0;   ///< mean over the dark ones
  double worst = 0;  ///< of any facet of the dark ones
};
Sides bothSides(float thickness, const HostFacets& facets, const std::vector<glm::vec3>& light) {
  Sides sides;
  double litArea = 0, darkArea = 0;
  for (size_t i = 0; i < light.size(); ++i) {
    const Side side = sideOf(thickness, facets.position[i], facets.normal[i]);
    if (side == Side::hidden) continue;
    (side == Side::lit ? litArea : darkArea) += facets.area[i];
    (side == Side::lit ? sides.lit : sides.dark) += facets.area[i] * light[i].x;
    if (side == Side::dark) sides.worst = std::max(sides.worst, double{light[i].x});
  }
  sides.lit /= litArea;
  sides.dark /= darkArea;
  return sides;
}

void thinWallCase(CheckRun& run) {
  for (const float thickness : kThickness) {
    double worst = 0, mean = 0, direct = 0;  // of both orders, as shares of the lit side's mean
    for (const bool reversed : {false, true}) {
      Scene scene = rowOfRooms(thickness);
      if (reversed) reverseTriangles(scene);
      const auto pipeline = run.prepare(std::move(scene));
      const HostFacets facets = run.facets(*pipeline);
      const Sides h = bothSides(thickness, facets, run.read(*pipeline, pipeline->lighting().indirect));
      const Sides d = bothSides(thickness, facets, run.read(*pipeline, pipeline->lighting().direct));
      worst = std::max(worst, h.worst / h.lit);
      mean = std::max(mean, h.dark / h.lit);
      direct = std::max(direct, d.worst / d.lit);
    }
    const std::string wall = fmt::format("{} voxels: ", thickness);
    run.atMost(wall + "most H of a dark facet / mean lit", worst, 1e-4);
    run.atMost(wall + "most D of a dark facet / mean lit", direct, 1e-4);
    run.info(wall + "mean H dark / lit", mean);
  }
}

void blurWallCase(CheckRun& run) {
  for (const float thickness : kThickness) {
    const auto pipeline = run.prepare(rowOfRooms(thickness));
    const HostFacets facets = run.facets(*pipeline);
    const double lit = bothSides(thickness, facets, run.read(*pipeline, pipeline->lighting().indirect)).lit;
    const Sides shaded = bothSides(thickness, facets, run.read(*pipeline, pipeline->lighting().shaded()));
    double pixel = 0;
    for (const Camera& camera : pipeline->scene().cameras)
      for (const glm::vec4& p : run.picture(*pipeline, camera, VIEW_IRRADIANCE, {96, 96}).pixels)
        pixel = std::max(pixel, double{p.x});
    const std::string wall = fmt::format("{} voxels: ", thickness);
    run.atMost(wall + "most blurred H of a dark facet / mean lit", shaded.worst / lit, 0.005);
    run.atMost(wall + "brightest pixel of the dark side / mean lit", pixel / lit, 0.005);
  }
}

Scene quarterVoxelScene() {
  return rowOfRooms(0.25f);
}

}  // namespace

std::vector<CheckCase> leakCases() {
  return {
      {.name = "thin-wall",
       .setup = "walls of 0-3 voxels at phases 0 .3 .5 .9 x triangle order, light on one side",
       .oracle = "dark side 0",
       .mark = "<= .01 %",
       .run = thinWallCase,
       .scene = quarterVoxelScene},
      {.name = "blur-wall",
       .setup = "blur filter across those walls: facets, and pictures from the dark side",
       .oracle = "0",
       .mark = "<= .5 %",
       .run = blurWallCase,
       .scene = quarterVoxelScene},
  };
}

}  // namespace irad
