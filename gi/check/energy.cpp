// Conservation and linearity: reciprocity, energy, row sums, superposition.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "gi/check/balance.h"
#include "gi/check/cases.h"
#include "gi/check/scenes.h"
#include "gi/lighting.h"

namespace irad {
namespace {

constexpr glm::vec3 kRoom(1.0f, 0.7f, 0.5f);  ///< edges of the reciprocity room
constexpr float kBall = 0.15f;                ///< radius of the ball in it

/// A box of three pairs of unequal walls around a ball: seven groups of known areas, told apart by material colour.
Scene groupsScene() {
  SceneBuilder b;
  std::vector<uint32_t> walls;
  for (int i = 0; i < 6; ++i) walls.push_back(b.material(glm::vec3(0.1f * static_cast<float>(i + 1))));
  b.box(walls, -0.5f * kRoom, 0.5f * kRoom, /*inward=*/true);
  b.sphere(b.material(glm::vec3(0.7f)), glm::vec3(0.1f, -0.05f, 0), kBall, /*inward=*/false, 48);
  return b.finish("groups");
}

void reciprocityCase(CheckRun& run) {
  const auto pipeline = run.prepare(groupsScene());
  const HostFacets facets = run.facets(*pipeline);
  std::vector<size_t> group;
  for (const glm::vec3& rho : facets.albedo) group.push_back(static_cast<size_t>(std::lround(rho.x * 10)) - 1);
  std::array<double, 7> area{};
  for (int axis = 0; axis < 3; ++axis)
    area[2 * axis] = area[2 * axis + 1] = double{kRoom[(axis + 1) % 3]} * kRoom[(axis + 2) % 3];
  area[6] = 4 * std::numbers::pi * kBall * kBall;

  // Means over a group are weighted by what each facet takes of its area.
  std::array<std::array<double, 7>, 7> f{}, hits{};
  std::array<double, 7> weight{};
  forEachRow(run.context, pipeline->matrix(), [&](uint32_t r, const HostRow& row) {
    weight[group[r]] += facets.area[r];
    for (size_t e = 0; e < row.columns.size(); ++e) {
      const size_t j = group[row.columns[e]];
      f[group[r]][j] += facets.area[r] * row.hits[e] * double{row.weight};
      hits[group[r]][j] += row.hits[e];
    }
  });
  for (size_t i = 0; i < 7; ++i)
    for (size_t j = i + 1; j < 7; ++j) {
      const double there = area[i] * f[i][j] / weight[i], back = area[j] * f[j][i] / weight[j];
      if (there == 0 && back == 0) continue;
      const double sigma = std::sqrt(1 / std::max(hits[i][j], 1.0) + 1 / std::max(hits[j][i], 1.0));
      run.near(fmt::format("A F of {} and {}, ratio", i, j), there / back, 1, std::max(0.02, 3 * sigma));
    }
}

/// Power emitted over power absorbed plus escaped.
void balance(CheckRun& run, const std::string& name, Scene scene) {
  const auto pipeline = run.prepare(std::move(scene));
  const EnergyShares energy = energyShares(run, *pipeline);
  run.info(name + ": escaped share", energy.escaped);
  run.near(name + ": (absorbed + escaped) / emitted", energy.accounted, 1, 0.02);
}

/// A closed room with a lamp in its ceiling and a ball; `open`: without its front.
Scene litRoom(bool open, bool sun) {
  SceneBuilder b;
  const uint32_t m = b.material(glm::vec3(0.7f)), lamp = b.material(glm::vec3(0.1f), glm::vec3(sun ? 0.0f : 5.0f));
  const glm::vec3 lo(-1), hi(1);
  const auto wall = [&](int axis, int side) {  // one inward wall
    glm::vec3 c[4];
    const int u = (axis + 1) % 3, v = (axis + 2) % 3;
    for (int k = 0; k < 4; ++k) {
      c[k][axis] = side ? hi[axis] : lo[axis];
      c[k][u] = k == 1 || k == 2 ? hi[u] : lo[u];
      c[k][v] = k >= 2 ? hi[v] : lo[v];
    }
    const uint32_t material = axis == 1 && side == 1 ? lamp : m;
    side ? b.quad(material, c[0], c[3], c[2], c[1]) : b.quad(material, c[0], c[1], c[2], c[3]);
  };
  for (int axis = 0; axis < 3; ++axis)
    for (int side = 0; side < 2; ++side)
      if (!open || axis != 2 || side != 1) wall(axis, side);
  b.sphere(m, glm::vec3(0.2f, -0.4f, -0.1f), 0.4f, /*inward=*/false, 48);
  if (sun) b.sun(glm::vec3(0.3f, -0.5f, -1), 3.0f);
  b.camera({0, 0, open ? 3.5 : 0.95}, {0, -0.2, -1});
  return b.finish(open ? "open room" : "closed room");
}
Scene openRoom() {
  return litRoom(/*open=*/true, /*sun=*/false);
}

void energyCase(CheckRun& run) {
  balance(run, "closed room", litRoom(/*open=*/false, /*sun=*/false));
  balance(run, "open room", openRoom());
  balance(run, "open room in the sun", litRoom(/*open=*/true, /*sun=*/true));
}

void rowSumsCase(CheckRun& run) {
  const auto check = [&](const std::string& name, Scene scene) {
    const auto pipeline = run.prepare(std::move(scene));
    double least = 1, most = 0;
    forEachRow(run.context, pipeline->matrix(), [&](uint32_t, const HostRow& row) {
      least = std::min(least, row.sum());
      most = std::max(most, row.sum());
    });
    run.near(name + ": least row sum", std::min(least, 0.0), 0, 0);
    run.atMost(name + ": largest row sum", most, 1 + 4e-6);
  };
  check("open room", openRoom());
  check("tilted boxes", furnaceInner(0.5f));
  for (const auto& path : run.options.scenes) check(path.stem().string(), loadScene(path));
}

void superpositionCase(CheckRun& run) {
  Settings settings = run.settings;
  settings.solver.tolerance = 1e-6f;
  const auto pipeline = run.prepare(litRoom(/*open=*/true, /*sun=*/false), settings);
  const HostFacets facets = run.facets(*pipeline);
  // Two lamps, given as direct light. What the scene's own emission brings is solved alone and subtracted.
  std::vector<glm::vec3> first, second, both;
  for (const glm::dvec3& n : facets.normal) {
    first.emplace_back(std::max(0.0, n.y), std::max(0.0, n.y), 0);
    second.emplace_back(0, std::max(0.0, n.x), 2 * std::max(0.0, n.x));
    both.push_back(first.back() + second.back());
  }
  const auto solved = [&](const std::vector<glm::vec3>& direct) {
    run.setDirect(*pipeline, direct);
    pipeline->prepare();
    return run.read(*pipeline, pipeline->lighting().indirect);
  };
  const std::vector<glm::vec3> none = solved(std::vector<glm::vec3>(facets.count(), glm::vec3(0)));
  const std::vector<glm::vec3> h1 = solved(first), h2 = solved(second), h = solved(both);
  double worst = 0, largest = 0;
  for (size_t i = 0; i < h.size(); ++i) {
    const glm::dvec3 sum = glm::dvec3(h1[i]) + glm::dvec3(h2[i]) - glm::dvec3(none[i]);
    for (int c = 0; c < 3; ++c) {
      worst = std::max(worst, std::abs(sum[c] - h[i][c]));
      largest = std::max(largest, double{h[i][c]});
    }
  }
  run.atMost("|x(E1) + x(E2) - x(E1 + E2)| / max", worst / largest, 1e-5);
}

}  // namespace

std::vector<CheckCase> energyCases() {
  return {
      {"reciprocity", "unequal box around a ball, by groups of faces", "A_i F_ij = A_j F_ji", "max(2 %, 3 sigma)",
       reciprocityCase, groupsScene},
      {"energy", "closed and open rooms, by lamp and by sun", "sum A (M + D) = sum A (1 - rho)(D + H) + escaped",
       "<= 2 %", energyCase, openRoom},
      {"row-sums", "check scenes and every scene shipped", "0 <= sum_j F_ij <= 1", "+ 4e-6", rowSumsCase},
      {"superposition", "two lights over a lamp", "x(E1 + E2) = x(E1) + x(E2)", "1e-5 of the largest",
       superpositionCase, openRoom},
  };
}

}  // namespace irad
