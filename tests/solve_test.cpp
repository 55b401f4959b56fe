// Jacobi and scatter on the device against the oracle and closed forms (docs/method.md 1, 6, 7; docs/stability.md).
#include <array>
#include <glm/gtc/packing.hpp>
#include <numeric>

#include "gi/facets.h"
#include "gi/gather_emitters.h"
#include "gi/grid.h"
#include "gi/lighting.h"
#include "gi/matrix.h"
#include "gi/oracle/rays.h"
#include "gi/scatter.h"
#include "gi/solve.h"
#include "gi/thesis/volume.h"
#include "renderer/base/error.h"
#include "shaders/shared/sampling.h"
#include "tests/gi_fixture.h"

namespace irad::test::solve_suite {
namespace {

class Solve : public GiTest {
 protected:
  void setAlbedo(const FacetList& facets, float rho) {
    const std::vector<glm::uvec2> albedo(facets.count, packAlbedo(glm::vec3(rho)));
    upload(context(), facets.albedo, std::as_bytes(std::span(albedo)));
  }
  void setDirect(const Lighting& light, const std::vector<glm::vec4>& direct) {
    upload(context(), light.direct, std::as_bytes(std::span(direct)));
  }
  std::vector<glm::vec4> values(const Buffer& buffer) { return downloadAs<glm::vec4>(context(), buffer); }
  /// Mean over facets and extremes of the red channel.
  struct Spread {
    double mean = 0, least = 1e30, most = -1e30;
  };
  Spread spread(const Buffer& buffer) {
    Spread s;
    const std::vector<glm::vec4> v = values(buffer);
    for (const glm::vec4& x : v) {
      s.mean += double{x.x} / static_cast<double>(v.size());
      s.least = std::min(s.least, double{x.x});
      s.most = std::max(s.most, double{x.x});
    }
    return s;
  }
  /// A scene's matrix, and its light at rest.
  std::pair<FormFactors, Lighting> solved(Scene scene, const Settings& settings) {
    const World w = world(std::move(scene), settings);
    FormFactors m = buildMatrix(context(), w.facets, w.field, settings);
    Lighting light = makeLighting(context(), w.facets, settings);
    solve(context(), w.facets, m, light, settings, 1000);
    return {std::move(m), std::move(light)};
  }
  static std::vector<glm::vec4> someLight(uint32_t facets) {
    std::vector<glm::vec4> d(facets);
    for (uint32_t i = 0; i < facets; ++i)
      d[i] = glm::vec4(unitFloat(hashUint(3 * i)), unitFloat(hashUint(3 * i + 1)), unitFloat(hashUint(3 * i + 2)), 0);
    return d;
  }
};

TEST_F(Solve, FurnaceBox) {
  Settings settings = at(32, 64);
  settings.solver.tolerance = 1e-4f;
  const World w = world(furnaceBox(0.5f), settings);
  const FormFactors m = buildMatrix(context(), w.facets, w.field, settings);
  Lighting light = makeLighting(context(), w.facets, settings);
  for (const float rho : {0.1f, 0.5f, 0.8f, 0.9f, 0.95f}) {
    setAlbedo(w.facets, rho);
    const SolveReport report = solve(context(), w.facets, m, light, settings, 1000);
    const Spread b = spread(light.radiosity);
    fmt::print("rho {}: {} sweeps, B (1 - rho) mean {:.6f} min {:.6f}, bound {:.2g}\n", rho, report.sweeps,
               b.mean * (1 - rho), b.least * (1 - rho), report.bound);
    EXPECT_TRUE(report.converged);
    EXPECT_NEAR(b.mean * (1 - rho), 1.0, 1e-3);
    EXPECT_GE(b.least * (1 - rho), 0.99);
    EXPECT_NEAR(report.largestGain, rho, 1e-4);
    // The bound holds: the true error of B is known here.
    EXPECT_LE(std::abs(b.mean - 1 / (1 - rho)), report.bound + 5e-4 / (1 - rho));
    EXPECT_EQ(report.nonFinite + report.negative, 0u);
  }
  // lambda solves another system (docs/method.md 1): lambda (1 - rho) / (1 - lambda rho) of the truth.
  setAlbedo(w.facets, 0.5f);
  settings.solver.gpu.lambda = 0.8f;
  solve(context(), w.facets, m, light, settings, 1000);
  EXPECT_NEAR(spread(light.radiosity).mean * 0.5, 0.8 * 0.5 / (1 - 0.8 * 0.5), 1e-3);
  // omega does not.
  settings.solver.gpu = {1.0f, 0.6f, 1e-12f};
  EXPECT_TRUE(solve(context(), w.facets, m, light, settings, 1000).converged);
  EXPECT_NEAR(spread(light.radiosity).mean * 0.5, 1.0, 1e-3);
}

TEST_F(Solve, FurnaceSphere) {
  Settings settings = at(32, 64);
  const auto [m, light] = solved(furnaceSphere(0.5f), settings);
  const Spread b = spread(light.radiosity);
  fmt::print("sphere: B (1 - rho) mean {:.5f} min {:.5f} max {:.5f}; escaped {} invalid {} of {}\n", b.mean * 0.5,
             b.least * 0.5, b.most * 0.5, m.stats.escaped, m.stats.invalid, m.stats.rays);
  EXPECT_NEAR(b.mean * 0.5, 1.0, 5e-3);
}

TEST_F(Solve, FurnaceTilted) {
  Settings settings = at(32, 64);
  const auto [m, light] = solved(furnaceTilted(0.5f), settings);
  std::vector<float> b;
  for (const glm::vec4& v : values(light.radiosity)) b.push_back(0.5f * v.x);
  std::sort(b.begin(), b.end());
  const double mean = std::accumulate(b.begin(), b.end(), 0.0) / static_cast<double>(b.size());
  fmt::print("tilted: B (1 - rho) mean {:.5f} min {:.5f} 1st percentile {:.5f}; escaped {} invalid {} of {}\n", mean,
             b.front(), b.at(b.size() / 100), m.stats.escaped, m.stats.invalid, m.stats.rays);
  EXPECT_NEAR(mean, 1.0, 0.01);
  EXPECT_GE(b.at(b.size() / 100), 0.97);
}

TEST_F(Solve, SweepsEqualTheOracle) {
  Settings settings = at(20, 48);
  settings.solver.acceleration = SolverAcceleration::off;
  for (const MatrixFormat format : {MatrixFormat::csr, MatrixFormat::padded}) {
    useFormat(settings, format);
    const World w = world(lampRoom().finish("room"), settings);
    ASSERT_TRUE(w.facets.hasEmission);
    const std::vector<glm::vec4> direct = someLight(w.facets.count);
    std::vector<glm::dvec3> albedo, emission, d;
    for (const glm::uvec2& a : downloadAs<glm::uvec2>(context(), w.facets.albedo)) albedo.emplace_back(unpackAlbedo(a));
    for (const glm::vec3& e : downloadAs<glm::vec3>(context(), w.facets.emission)) emission.emplace_back(e);
    for (const glm::vec4& x : direct) d.emplace_back(x);
    const FormFactors m = buildMatrix(context(), w.facets, w.field, settings);
    std::vector<oracle::Row> rows;
    for (const HostRow& r : hostRows(context(), m)) {
      rows.push_back({r.columns, {}});
      for (const uint32_t h : r.hits) rows.back().weights.push_back(h * double{r.weight});
    }
    for (const SolverKernel kernel :
         {SolverKernel::tree, SolverKernel::subgroup, SolverKernel::row, SolverKernel::automatic}) {
      settings.solver.kernel = kernel;
      settings.solver.gpu = {0.8f, 0.7f, 1e-12f};
      Lighting light = makeLighting(context(), w.facets, settings);
      setDirect(light, direct);
      gatherEmitters(context(), w.facets, m, {}, settings, light);
      const SolveReport report = solve(context(), w.facets, m, light, settings, 5);
      EXPECT_EQ(report.sweeps, 5u);
      oracle::Light expected{std::vector<glm::dvec3>(w.facets.count), std::vector<glm::dvec3>(w.facets.count)};
      oracle::jacobi(rows, albedo, emission, d, settings.solver.gpu, 4, expected);
      const std::vector<glm::dvec3> before = expected.radiosity;
      oracle::jacobi(rows, albedo, emission, d, settings.solver.gpu, 1, expected);
      const std::vector<glm::vec4> b = values(light.radiosity), h = values(light.indirect);
      double delta = 0, largestH = 0, gain = 0;
      for (uint32_t i = 0; i < w.facets.count; ++i) {
        double sum = 0;
        for (const double f : rows[i].weights) sum += f;
        for (int c = 0; c < 3; ++c) {
          ASSERT_NEAR(b[i][c], expected.radiosity[i][c], 1e-5 * expected.radiosity[i][c] + 1e-12) << i;
          ASSERT_NEAR(h[i][c], expected.indirect[i][c], 1e-5 * expected.indirect[i][c] + 1e-12) << i;
          delta = std::max(delta, std::abs(expected.radiosity[i][c] - before[i][c]));
          largestH = std::max(largestH, expected.indirect[i][c]);
          gain = std::max(gain, 0.8 * albedo[i][c] * sum);
        }
      }
      EXPECT_NEAR(report.residual, delta, 1e-4 * delta);
      EXPECT_NEAR(report.largestH, largestH, 1e-5 * largestH);
      EXPECT_NEAR(report.largestGain, gain, 1e-5 * gain);
      // F M: one product with the exitance.
      oracle::Light emitted{emission, std::vector<glm::dvec3>(w.facets.count)};
      oracle::jacobi(rows, albedo, emission, d, settings.solver.gpu, 1, emitted);
      const std::vector<glm::vec4> fm = values(light.emitted);
      for (uint32_t i = 0; i < w.facets.count; ++i)
        for (int c = 0; c < 3; ++c) ASSERT_NEAR(fm[i][c], emitted.indirect[i][c], 1e-5 * emitted.indirect[i][c]);
    }
  }
}

TEST_F(Solve, LightsOffEndsInExactZeroAndDarkStaysZero) {
  Settings settings = at(20, 48);
  SceneBuilder builder;
  const uint32_t m0 = builder.material(glm::vec3(0.9f));
  builder.box({m0, m0, m0, m0, m0, m0}, glm::vec3(-1), glm::vec3(1), /*inward=*/true);
  const World w = world(builder.finish("white room"), settings);
  const FormFactors m = buildMatrix(context(), w.facets, w.field, settings);
  Lighting light = makeLighting(context(), w.facets, settings);
  const auto allZero = [&](const Buffer& b) {
    for (const glm::uvec4& word : downloadAs<glm::uvec4>(context(), b))
      if (glm::uvec3(word) != glm::uvec3(0)) return false;
    return true;
  };
  // No light at all.
  EXPECT_TRUE(solve(context(), w.facets, m, light, settings, 1000).converged);
  EXPECT_TRUE(allZero(light.radiosity) && allZero(light.indirect));
  EXPECT_FALSE(light.emitted);  // nothing emits

  setDirect(light, std::vector<glm::vec4>(w.facets.count, glm::vec4(1, 2, 3, 0)));
  EXPECT_TRUE(solve(context(), w.facets, m, light, settings, 1000).converged);
  const double lit = spread(light.radiosity).mean;
  EXPECT_NEAR(lit, 0.9 / (1 - 0.9), 0.02);
  // Cut: rho^k decay ...
  setDirect(light, std::vector<glm::vec4>(w.facets.count, glm::vec4(0)));
  solve(context(), w.facets, m, light, settings, 10);
  EXPECT_NEAR(spread(light.radiosity).mean, lit * std::pow(0.9, 10), 0.002 * lit);
  // ... then zero, within 200 sweeps in all, a few per frame as the window does it.
  uint32_t sweeps = 10;
  while (sweeps < 200) sweeps += solve(context(), w.facets, m, light, settings, 4).sweeps;
  EXPECT_TRUE(allZero(light.radiosity) && allZero(light.indirect)) << "largest H " << light.report.largestH;
}

TEST_F(Solve, EndsBetweenTwoSubmissions) {
  const Settings settings = at(12, 16);
  const World w = world(lampRoom().finish("room"), settings);
  const FormFactors m = buildMatrix(context(), w.facets, w.field, settings);
  Lighting light = makeLighting(context(), w.facets, settings);
  setDirect(light, someLight(w.facets.count));
  int asked = 0;
  EXPECT_THROW(solve(context(), w.facets, m, light, settings, 1000, [&] { return ++asked < 3; }), WorkError);
  EXPECT_EQ(asked, 3);
  // What has come of it is a start as good as any.
  EXPECT_TRUE(solve(context(), w.facets, m, light, settings, 1000).converged);
}

TEST_F(Solve, SameBitsTwiceAndWarmStartIsAtRest) {
  const Settings settings = at(20, 48);
  const World w = world(lampRoom().finish("room"), settings);
  const FormFactors m = buildMatrix(context(), w.facets, w.field, settings);
  const auto run = [&](Lighting& light) {
    setDirect(light, someLight(w.facets.count));
    return solve(context(), w.facets, m, light, settings, 1000);
  };
  Lighting a = makeLighting(context(), w.facets, settings), b = makeLighting(context(), w.facets, settings);
  const SolveReport first = run(a);
  run(b);
  EXPECT_TRUE(first.converged);
  EXPECT_EQ(downloadAs<uint32_t>(context(), a.radiosity), downloadAs<uint32_t>(context(), b.radiosity));
  EXPECT_EQ(downloadAs<uint32_t>(context(), a.indirect), downloadAs<uint32_t>(context(), b.indirect));
  EXPECT_LE(run(a).sweeps, 2u);
}

TEST_F(Solve, FirstGatherAndSweepsHaveTimingRowsOfTheirOwn) {
  const Settings settings = at(16, 32);
  const World w = world(lampRoom().finish("room"), settings);
  ASSERT_TRUE(w.facets.hasEmission);
  const FormFactors m = buildMatrix(context(), w.facets, w.field, settings);
  Lighting light = makeLighting(context(), w.facets, settings);
  Timings& timings = context().timings;
  const auto stages = [&](const auto& run) {
    context().device.waitIdle();
    context().begin().submitAndWait();  // delivers what is under way
    timings.reset();
    run();
    timings.endFrame(0, /*setup=*/false, 0);
    std::vector<std::string> names;
    for (const auto& [stage, ms] : timings.frames().back().stages)
      if (stage != "Readback") names.push_back(stage);
    return names;
  };
  const auto firstGather = [&] { gatherEmitters(context(), w.facets, m, {}, settings, light); };
  const auto sweep = [&] { solve(context(), w.facets, m, light, settings, 1); };
  EXPECT_EQ(stages(firstGather), (std::vector<std::string>{"GI Solve Emitters"}));
  EXPECT_EQ(stages(sweep), (std::vector<std::string>{"GI Solve"}));
  EXPECT_EQ(stages(sweep), (std::vector<std::string>{"GI Solve"}));  // F M is kept
  timings.reset();
}

TEST_F(Solve, DivergenceIsNoticed) {
  Settings settings = at(16, 32);
  settings.solver.gpu.lambda = 2.0f;  // x .9: gain 1.8
  const World w = world(furnaceBox(0.9f), settings);
  const FormFactors m = buildMatrix(context(), w.facets, w.field, settings);
  Lighting light = makeLighting(context(), w.facets, settings);
  const SolveReport report = solve(context(), w.facets, m, light, settings, 10000);
  EXPECT_TRUE(report.diverging);
  EXPECT_FALSE(report.converged);
  EXPECT_LE(report.sweeps, 100u);
  EXPECT_EQ(report.nonFinite, 0u);
}

TEST_F(Solve, Plates) {
  // Albedos .9 and .3 facing each other across a tenth of their side; finite-size corrected by quadrature of the double
  // integral over 32 x 32 patches of each plate. For infinite plates: 1.370 and .411.
  const float gap = 0.1f;
  const Settings settings = at(64, 256);
  const World w = world(plates(gap), settings);
  const FormFactors m = buildMatrix(context(), w.facets, w.field, settings);
  Lighting light = makeLighting(context(), w.facets, settings);
  EXPECT_TRUE(solve(context(), w.facets, m, light, settings, 1000).converged);
  const auto [mean0, mean1] = plateRadiosity(gap, 0.9, 0.3);
  double sum[2] = {0, 0}, count[2] = {0, 0};
  const std::vector<glm::vec4> b = values(light.radiosity);
  const auto shape = downloadAs<uint32_t>(context(), w.facets.shape);
  for (size_t i = 0; i < b.size(); ++i) {
    const int plate = decodeNormal(shape[i] & 0xFFFFu, NORMALS_OCT16).y > 0 ? 0 : 1;
    sum[plate] += b[i].x;
    ++count[plate];
  }
  fmt::print("plates: {:.4f} (expected {:.4f}), {:.4f} ({:.4f})\n", sum[0] / count[0], mean0, sum[1] / count[1], mean1);
  EXPECT_NEAR(sum[0] / count[0], mean0, 0.02 * mean0);
  EXPECT_NEAR(sum[1] / count[1], mean1, 0.02 * mean1);
}

TEST_F(Solve, TheVolumeHoldsRadiosity) {
  // T 5.9: alpha 1 exactly where solid, clamped to what fp16 holds.
  Settings settings = at(16, 16);
  settings.matrix.gpu.hitRule = HitRule::thesis;
  const Grid grid = makeGrid(glm::vec3(0), glm::vec3(1), 16);
  std::vector<uint32_t> voxel;
  for (uint32_t z = 4; z < 12; ++z)
    for (uint32_t x = 4; x < 12; ++x) voxel.push_back(packVoxel({x, 5u, z}));
  const std::vector<uint32_t> shape(voxel.size(), encodeNormal(glm::vec3(0, 1, 0), NORMALS_OCT16));
  const FacetList facets =
      uploadFacets(context(), grid, voxel, shape, std::vector<glm::uvec2>(voxel.size(), packAlbedo(glm::vec3(0.5f))),
                   {}, NormalEncoding::oct16);
  Lighting light = makeLighting(context(), facets, settings);
  light.report.clampedVoxels = 77;  // of a run before
  std::vector<uint64_t> texels(grid.voxels);
  const auto texel = [&](uint32_t v) { return glm::unpackHalf4x16(texels[voxelIndex(unpackVoxel(v), grid.dims)]); };
  const auto run = [&](const std::vector<glm::vec4>& radiosity) {
    upload(context(), light.radiosity, std::as_bytes(std::span(radiosity)));
    Frame frame = context().begin();
    scatter(frame, facets, FormFactors{}, light, settings);
    frame.submitAndWait();
    const std::vector<std::byte> bytes = download(context(), light.volume.image);
    ASSERT_EQ(bytes.size(), texels.size() * 8);
    std::memcpy(texels.data(), bytes.data(), bytes.size());
  };
  std::vector<glm::vec4> b(voxel.size(), glm::vec4(5, 5, 5, 0));
  b[0] = glm::vec4(1e6f, -1, 0.333f, 0);
  b[1].z = 65504.0f;  // just held
  run(b);
  EXPECT_FALSE(light.blurred) << "lookups in the volume blur by themselves";
  EXPECT_EQ(light.report.clampedVoxels, 1u);
  size_t present = 0;
  for (const uint64_t t : texels) {
    const glm::vec4 v = glm::unpackHalf4x16(t);
    EXPECT_TRUE(v.w == 0.0f ? t == 0 : v.w == 1.0f);
    present += v.w == 1.0f;
  }
  EXPECT_EQ(present, facets.solidVoxels);
  EXPECT_EQ(texel(voxel[0]).x, 65504.0f);
  EXPECT_EQ(texel(voxel[0]).y, 0.0f);
  EXPECT_NEAR(texel(voxel[0]).z, 0.333f, 2.45e-4f);  // one ulp: a store to fp16 may truncate (lavapipe does)
  EXPECT_EQ(texel(voxel[4]), glm::vec4(5, 5, 5, 1));

  // With edge removal B - lambda rho D (T eq. 23).
  setDirect(light, std::vector<glm::vec4>(b.size(), glm::vec4(2, 4, 20, 0)));
  settings.scatter.edgeRemoval = true;
  settings.solver.gpu.lambda = 0.3f;  // for a solve to come: this light was solved with .8
  light.gain.radiosity = 0.8f;
  run(std::vector<glm::vec4>(b.size(), glm::vec4(5, 5, 5, 0)));
  EXPECT_NEAR(texel(voxel[0]).x, 5 - 0.8f * 0.5f * 2, 0.005f);
  EXPECT_NEAR(texel(voxel[0]).y, 5 - 0.8f * 0.5f * 4, 0.005f);
  EXPECT_EQ(texel(voxel[0]).z, 0.0f);  // 5 - 8: held at zero
}

}  // namespace
}  // namespace irad::test::solve_suite
