// Furnaces: closed rooms in which light is the same everywhere, whatever the form factors, if only every row sums to 1.
#include <fmt/format.h>

#include "gi/check/cases.h"
#include "gi/check/scenes.h"
#include "gi/facets.h"
#include "gi/lighting.h"
#include "gi/matrix.h"

namespace irad {
namespace {

constexpr float kAlbedos[] = {0.1f, 0.5f, 0.8f, 0.9f, 0.95f};

struct FurnaceMarks {
  double mean;             ///< on the mean of B (1 - rho) / M
  double least = 0;        ///< on its least value; 0: none
  double percentile1 = 0;  ///< on its first percentile; 0: none
};

/// B = M / (1 - rho) everywhere, M = 1.
void furnace(CheckRun& run, Scene (*scene)(float), const FurnaceMarks& marks) {
  const auto pipeline = run.prepare(scene(0.5f));
  const size_t facets = pipeline->facets().count;
  for (const float rho : kAlbedos) {
    run.setAlbedo(*pipeline, std::vector<glm::vec3>(facets, glm::vec3(rho)));
    pipeline->prepare();
    std::vector<glm::vec3> share = run.read(*pipeline, pipeline->lighting().radiosity);
    for (glm::vec3& b : share) b *= 1 - rho;
    const Spread s = spread(share);
    const std::string at = fmt::format(" rho {}", rho);
    run.near("mean" + at, s.mean, 1, marks.mean);
    if (marks.least > 0) run.atLeast("min" + at, s.least, marks.least);
    if (marks.percentile1 > 0) run.atLeast("1st percentile" + at, s.percentile1, marks.percentile1);
  }
  run.info("escaped rays",
           static_cast<double>(pipeline->matrix().stats.escaped) / static_cast<double>(pipeline->matrix().stats.rays));
}

void furnaceBoxCase(CheckRun& run) {
  furnace(run, furnaceBox, {.mean = 0.001, .least = 0.99});
}
void furnaceSphereCase(CheckRun& run) {
  furnace(run, furnaceSphere, {.mean = 0.005});
}
void furnaceTiltedCase(CheckRun& run) {
  furnace(run, furnaceTilted, {.mean = 0.01, .percentile1 = 0.97});
}
void furnaceInnerCase(CheckRun& run) {
  furnace(run, furnaceInner, {.mean = 0.05});
}

/// A sphere sees itself evenly (F_ij = A_j / A): H = f M + rho H.
void sphereCapCase(CheckRun& run) {
  const auto pipeline = run.prepare(sphereCap());
  // By area: small facets have fewer rays.
  const std::vector<double> area = run.facets(*pipeline).area;
  const std::vector<glm::vec3> h = run.read(*pipeline, pipeline->lighting().indirect);
  double whole = 0, sum = 0, squares = 0;
  for (size_t i = 0; i < h.size(); ++i) {
    whole += area[i];
    sum += area[i] * double{h[i].x};
    squares += area[i] * double{h[i].x} * double{h[i].x};
  }
  const double mean = sum / whole;
  run.near("mean H", mean, 1.25, 0.03 * 1.25);
  run.atMost("std of H / mean", std::sqrt(std::max(squares / whole - mean * mean, 0.0)) / mean, 0.01);
}

Scene boxScene() {
  return furnaceBox(0.5f);
}
Scene sphereScene() {
  return furnaceSphere(0.5f);
}
Scene tiltedScene() {
  return furnaceTilted(0.5f);
}
Scene innerScene() {
  return furnaceInner(0.5f);
}
/// rho = .5, M = 1: H = B = 2.
glm::dvec3 furnaceLight(const glm::dvec3&, const glm::dvec3&) {
  return glm::dvec3(2);
}
glm::dvec3 capLight(const glm::dvec3&, const glm::dvec3&) {
  return glm::dvec3(1.25);
}

}  // namespace

std::vector<CheckCase> furnaceCases() {
  constexpr const char* oracle = "B = M/(1 - rho), rho = .1 .5 .8 .9 .95";
  return {
      {"furnace-box", "closed axis-aligned box, all facets emit", oracle, "mean +- .1 %, min >= .99", furnaceBoxCase,
       boxScene, furnaceLight},
      {"furnace-sphere", "closed sphere, all facets emit", oracle, "+- .5 %", furnaceSphereCase, sphereScene,
       furnaceLight},
      {"furnace-tilted", "box turned 31 degrees about (1, 2, 3)", oracle, "+- 1 %, 1st percentile >= .97",
       furnaceTiltedCase, tiltedScene, furnaceLight},
      {"furnace-inner", "tilted box around a second tilted box", oracle, "+- 5 % (goal 2 %)", furnaceInnerCase,
       innerScene, furnaceLight},
      {"sphere-cap", "sphere, a cap of a quarter of its area emits, rho = .8", "H = f M/(1 - rho) = 1.25 M everywhere",
       "+- 3 %, std <= 1 %", sphereCapCase, sphereCap, capLight},
  };
}

}  // namespace irad
