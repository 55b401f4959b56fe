// Rows of the matrix, averaged over walls, against Howell's catalogue of form factors.
#include <fmt/format.h>

#include <cmath>

#include "gi/check/cases.h"
#include "gi/check/scenes.h"
#include "gi/lighting.h"

namespace irad {
namespace {

/// Which wall of an axis-aligned room a facet belongs to: 2 x axis + (0: faces +, 1: faces -).
std::vector<int> walls(const HostFacets& facets) {
  std::vector<int> out;
  for (const glm::dvec3& n : facets.normal) {
    const int axis = std::abs(n.x) > 0.9 ? 0 : std::abs(n.y) > 0.9 ? 1 : 2;
    out.push_back(2 * axis + (n[axis] < 0));
  }
  return out;
}

/// Mean over the facets of wall `from` of the share of their rays that meets each wall.
std::array<double, 6> formFactors(CheckRun& run, const Pipeline& pipeline, int from) {
  const std::vector<int> wall = walls(run.facets(pipeline));
  std::array<double, 6> sums{};
  double facets = 0;
  forEachRow(run.context, pipeline.matrix(), [&](uint32_t r, const HostRow& row) {
    if (wall[r] != from) return;
    ++facets;
    for (size_t e = 0; e < row.columns.size(); ++e) sums[wall[row.columns[e]]] += row.hits[e] * double{row.weight};
  });
  for (double& sum : sums) sum /= facets;
  return sums;
}

constexpr int kFloor = 2, kCeiling = 3;  ///< faces +y, -y

Settings at(const CheckRun& run, uint32_t resolution) {
  Settings settings = run.settings;
  settings.voxel.resolution = resolution;
  return settings;
}

void parallelCase(CheckRun& run) {
  const double expected = formFactorParallelSquares(1);
  const uint32_t n = run.settings.voxel.resolution;
  std::vector<double> errors;
  for (const uint32_t resolution : {n / 4, n / 2, n}) {
    const auto pipeline = run.prepare(unitCube(), at(run, resolution));
    const double f = formFactors(run, *pipeline, kCeiling)[kFloor];
    errors.push_back(std::abs(f - expected));
    if (resolution == n)
      run.near("F ceiling to floor", f, expected, 0.01 * expected);
    else
      run.info(fmt::format("F at N = {}", resolution), f);
  }
  run.require("error falls from N/4 to N", errors.back() <= errors.front());
}

void perpendicularCase(CheckRun& run) {
  const double expected = formFactorPerpendicularSquares();
  const auto pipeline = run.prepare(unitCube());
  const std::array<double, 6> f = formFactors(run, *pipeline, kCeiling);
  double all = 0, worst = expected;
  for (int wall = 0; wall < 6; ++wall) {
    all += f[wall];
    if (wall != kFloor && wall != kCeiling && std::abs(f[wall] - expected) > std::abs(worst - expected))
      worst = f[wall];
  }
  run.near("F ceiling to wall, worst of four", worst, expected, 0.01 * expected);
  run.near("sum of the five", all, 1, 0.01);
  run.near("F ceiling to itself", f[kCeiling], 0, 1e-9);
}

void distanceCase(CheckRun& run) {
  for (const float d : {0.1f, 0.5f, 2.0f}) {
    // N voxels along the square's side, not along the gap.
    const auto resolution =
        static_cast<uint32_t>(static_cast<float>(run.settings.voxel.resolution) * std::max(1.0f, d));
    const auto pipeline = run.prepare(parallelSquares(d), at(run, resolution));
    const double expected = formFactorParallelSquares(d);
    run.near(fmt::format("F at distance {}", d), formFactors(run, *pipeline, kFloor)[kCeiling], expected,
             0.02 * expected);
  }
}

constexpr float kGap = 0.1f;

void platesCase(CheckRun& run) {
  const auto pipeline = run.prepare(plates(kGap));
  const std::vector<int> wall = walls(run.facets(*pipeline));
  const std::vector<glm::vec3> b = run.read(*pipeline, pipeline->lighting().radiosity);
  double sum[2] = {0, 0}, count[2] = {0, 0};
  for (size_t i = 0; i < b.size(); ++i) {
    const int plate = wall[i] == kFloor ? 0 : 1;
    sum[plate] += b[i].x;
    ++count[plate];
  }
  const auto [first, second] = plateRadiosity(kGap, 0.9, 0.3);
  run.near("B of the emitting plate", sum[0] / count[0], first, 0.02 * first);
  run.near("B of the other", sum[1] / count[1], second, 0.02 * second);
}

Scene cubeScene() {
  return unitCube();
}
Scene squaresScene() {
  return parallelSquares(0.5f);
}
Scene platesScene() {
  return plates(kGap);
}

}  // namespace

std::vector<CheckCase> formFactorCases() {
  return {
      {"ff-parallel", "unit cube, rho = 0, ceiling to floor", "F = .199825 (Howell C-11)",
       "+- 1 %, error falls as N grows", parallelCase, cubeScene},
      {"ff-perpendicular", "unit cube, ceiling to wall", ".200044 (Howell C-14); the five sum to 1", "+- 1 %",
       perpendicularCase, cubeScene},
      {"ff-distance", "parallel unit squares at d = .1 .5 2", ".8270 .4153 .0686", "+- 2 %", distanceCase,
       squaresScene},
      {"plates", "two plates a tenth of their side apart, rho .9 / .3",
       "1.370 / .411 of infinite ones, corrected for their size by quadrature", "+- 2 %", platesCase, platesScene},
  };
}

}  // namespace irad
