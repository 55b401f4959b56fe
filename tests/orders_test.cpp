// How fast errors fall: with rays, with sweeps, with voxels (docs/accuracy.md, "How fast errors fall").
#include <algorithm>
#include <cmath>

#include "gi/check/path_tracer.h"
#include "gi/check/run.h"
#include "gi/lighting.h"
#include "gi/matrix.h"
#include "gi/solve.h"
#include "renderer/metrics.h"
#include "shaders/shared/debug_views.h"
#include "tests/gi_fixture.h"

namespace irad::test::orders_suite {
namespace {

/// p of error = c x^-p, by least squares of the logarithms.
double order(const std::vector<double>& x, const std::vector<double>& error) {
  const auto n = static_cast<double>(x.size());
  double sx = 0, sy = 0, sxx = 0, sxy = 0;
  for (size_t i = 0; i < x.size(); ++i) {
    const double lx = std::log(x[i]), ly = std::log(error[i]);
    sx += lx, sy += ly, sxx += lx * lx, sxy += lx * ly;
  }
  return -(n * sxy - sx * sy) / (n * sxx - sx * sx);
}

class Orders : public GiTest {
 protected:
  std::vector<double> red(const Buffer& buffer) {
    std::vector<double> out;
    for (const glm::vec4& v : downloadAs<glm::vec4>(context(), buffer)) out.push_back(v.x);
    return out;
  }
  /// H of every facet, by its matrix alone.
  std::vector<double> indirect(const World& w, Settings settings) {
    settings.matrix.emitterSampling = EffectMode::off;
    const FormFactors m = buildMatrix(context(), w.facets, w.field, settings);
    Lighting light = makeLighting(context(), w.facets, settings);
    solve(context(), w.facets, m, light, settings, 1000);
    return red(light.indirect);
  }
  static double rms(const std::vector<double>& a, const std::vector<double>& b) {
    double sum = 0;
    for (size_t i = 0; i < a.size(); ++i) sum += (a[i] - b[i]) * (a[i] - b[i]);
    return std::sqrt(sum / static_cast<double>(a.size()));
  }
};

TEST_F(Orders, RaysOnAFloorUnderALamp) {
  Settings settings = at(40, 64);
  const World w = world(parallelSquares(0.5f), settings);
  // The truth: many rays, with other seeds than those that are judged.
  std::vector<double> truth(w.facets.count, 0.0);
  constexpr uint32_t kSeeds = 4;
  settings.matrix.gpu.rays = 4096;
  for (uint32_t seed = 0; seed < kSeeds; ++seed) {
    settings.matrix.gpu.seed = 1000 + seed;
    const std::vector<double> h = indirect(w, settings);
    for (size_t i = 0; i < h.size(); ++i) truth[i] += h[i] / kSeeds;
  }
  std::vector<double> rays, error;
  for (const uint32_t n : {16u, 32u, 64u, 128u, 256u, 512u}) {
    settings.matrix.gpu.rays = n;
    double sum = 0;
    for (uint32_t seed = 0; seed < 3; ++seed) {
      settings.matrix.gpu.seed = seed;
      sum += rms(indirect(w, settings), truth) / 3;
    }
    rays.push_back(n), error.push_back(sum);
    fmt::print("{} rays: rms {:.3g}\n", n, sum);
  }
  const double p = order(rays, error);
  fmt::print("error falls as rays^-{:.2f}\n", p);
  EXPECT_GE(p, 0.7) << "independent directions have .5";
  EXPECT_LT(p, 1.5);
}

TEST_F(Orders, SweepsByTheLargestGainOrFaster) {
  for (const SolverAcceleration acceleration : {SolverAcceleration::off, SolverAcceleration::anderson}) {
    Settings settings = at(12, 64);
    settings.solver.acceleration = acceleration;
    settings.solver.tolerance = 1e-7f;
    const World w = world(furnaceBox(0.8f), settings);
    const FormFactors m = buildMatrix(context(), w.facets, w.field, settings);
    Lighting exact = makeLighting(context(), w.facets, settings);
    const SolveReport solved = solve(context(), w.facets, m, exact, settings, 1000);
    ASSERT_NEAR(solved.largestGain, 0.8, 1e-3);
    const std::vector<double> truth = red(exact.radiosity);
    const double dark = *std::ranges::max_element(truth);  // the error before the first sweep
    for (const uint32_t sweeps : {4u, 8u, 16u, 24u}) {
      Lighting light = makeLighting(context(), w.facets, settings);
      solve(context(), w.facets, m, light, settings, sweeps);
      const std::vector<double> b = red(light.radiosity);
      double error = 0;
      for (size_t i = 0; i < b.size(); ++i) error = std::max(error, std::abs(b[i] - truth[i]));
      const double bound = dark * std::pow(solved.largestGain, sweeps);
      fmt::print("{} sweeps: error {:.3g}, by the gain {:.3g}\n", sweeps, error, bound);
      EXPECT_LE(error, bound * 1.001 + 1e-5 * dark) << sweeps;  // fp32
    }
  }
}

TEST_F(Orders, VoxelsAroundABall) {
  if (!hasPathTracer()) GTEST_SKIP() << "this build has no path tracer (IRAD_EMBREE)";
  constexpr glm::uvec2 kSize{64, 64};
  Scene scene = lampRoom().finish("ball");
  const Camera camera = scene.cameras.at(0);
  const TracedPicture truth = makePathTracer(scene)->render(camera, kSize, {.samples = 512, .centred = true});
  const auto half = [&](size_t which) {
    std::vector<glm::vec4> out;
    for (const glm::dvec3& v : truth.indirect.half[which]) out.emplace_back(glm::vec3(v), 1);
    return out;
  };
  std::vector<double> voxels, error;
  for (const uint32_t resolution : {8u, 16u, 32u}) {
    CheckRun run(context(), at(resolution, 256), {});
    const auto pipeline = run.prepare(scene);
    const CheckPicture picture = run.picture(*pipeline, camera, VIEW_INDIRECT, kSize);
    voxels.push_back(resolution);
    error.push_back(measurePicture(kSize, picture.pixels, half(0), half(1), 1).blockRelMse);
    fmt::print("N = {}: relMSE {:.3g}\n", resolution, error.back());
  }
  for (size_t i = 0; i + 1 < error.size(); ++i) EXPECT_LT(error[i + 1], error[i]);
}

}  // namespace
}  // namespace irad::test::orders_suite
