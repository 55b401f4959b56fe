// Brute force (docs/method.md 9): frames against the matrix's product, the mean and its standard error against the
// formulas and against independent runs, and against the matrix's solution.
#include "gi/brute_force.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "gi/inspect.h"
#include "gi/lighting.h"
#include "gi/matrix.h"
#include "gi/pipeline.h"
#include "gi/plan.h"
#include "gi/sky.h"
#include "gi/solve.h"
#include "gi/subsystems.h"
#include "gi/views/views.h"
#include "gi/watch.h"
#include "renderer/base/error.h"
#include "renderer/targets.h"
#include "shaders/shared/sampling.h"
#include "tests/gi_fixture.h"

namespace irad::test::brute_force_suite {
namespace {

using Values = std::vector<glm::dvec3>;

class BruteForce : public GiTest {
 protected:
  static Settings framewise(uint32_t resolution, uint32_t rays, uint32_t frames) {
    Settings s = at(resolution, rays);
    s.solver.method = SolverMethod::bruteForce;
    s.solver.frames = frames;
    s.solver.tolerance = 1e-6f;  // all of the frames
    s.light.shadowResolution = 256;
    return s;
  }
  /// The same with a matrix, solved far below its noise.
  static Settings byMatrix(Settings s) {
    s.solver.method = SolverMethod::matrix;
    s.matrix.emitterSampling = EffectMode::off;  // rays meet the emitters, as the frames' do
    return s;
  }
  Values values(const Buffer& buffer, uint32_t count) {
    const auto all = downloadAs<glm::vec4>(context(), buffer);
    Values v(count);
    for (uint32_t i = 0; i < count; ++i) v[i] = glm::dvec3(all[i]);
    return v;
  }
  std::vector<std::byte> bits(const Pipeline& p) {
    std::vector<std::byte> all;
    const Lighting& light = p.lighting();
    for (const Buffer* b : {&light.indirect, &light.radiosity, &light.emitted, &light.frameMean.standardError})
      if (*b) {
        const std::vector<std::byte> bytes = download(context(), *b);
        all.insert(all.end(), bytes.begin(), bytes.end());
      }
    return all;
  }
  std::unique_ptr<Pipeline> prepared(const Scene& scene, const Settings& settings) {
    auto p = std::make_unique<Pipeline>(context(), scene, settings);
    p->prepare();
    return p;
  }
  static const Scene& room() {
    static const Scene scene = mixedRoom();
    return scene;
  }
  static const Scene& box() {
    static const Scene scene = loadScene(assets() / "box.glb");
    return scene;
  }
};

/// sum_j F_ij x_j by the matrix's rows, in double precision.
Values product(const std::vector<HostRow>& rows, const Values& x) {
  Values out(rows.size(), glm::dvec3(0));
  for (size_t i = 0; i < rows.size(); ++i)
    for (size_t e = 0; e < rows[i].columns.size(); ++e)
      out[i] += double{rows[i].weight} * rows[i].hits[e] * x[rows[i].columns[e]];
  return out;
}

double largest(const glm::dvec3& v) {
  return std::max({v.x, v.y, v.z});
}

void expectNear(const Values& found, const Values& expected, double share, const char* what) {
  ASSERT_EQ(found.size(), expected.size());
  double most = 0, worst = 0;
  for (size_t i = 0; i < found.size(); ++i) {
    most = std::max(most, largest(expected[i]));
    worst = std::max(worst, largest(glm::abs(found[i] - expected[i])));
  }
  EXPECT_GT(most, 0) << what;
  EXPECT_LE(worst, share * most) << what;
}

/// Frame k brings F_k B_k of the matrix F_k that its rays make, the first being the matrix's own; the mean has weights
/// 1, 4, 9, and its squared standard error is s^2 sum w^2 / (sum w)^2, s^2 = sum w (h - mean)^2 / (sum w - sum w^2 /
/// sum w).
TEST_F(BruteForce, FramesBringWhatTheirMatricesWould) {
  for (const auto& [rule, under] :
       {std::pair{HitRule::triangles, false}, {HitRule::triangles, true}, {HitRule::thesis, false}}) {
    SCOPED_TRACE(fmt::format("{}, sky {}", nameOf(rule), under));
    Settings settings = framewise(16, 48, 3);
    settings.matrix.gpu.hitRule = rule;
    settings.matrix.gpu.seed = 7;
    if (under) settings.effects.sky = EffectMode::on;
    const World w = world(under ? stillLife().finish("still life") : lampRoom().finish("room"), settings);
    const uint32_t n = w.facets.count;
    SkyOnDevice sky;
    if (under) {
      settings.sky.source = SkySource::preetham;
      place(context(), makeSky(settings.sky, {}), sky);
      ASSERT_TRUE(sky);
    }
    Lighting light = makeLighting(context(), w.facets, settings);
    std::vector<glm::vec4> direct(n);
    for (uint32_t i = 0; i < n; ++i) direct[i] = glm::vec4(unitFloat(hashUint(i)), unitFloat(hashUint(i + n)), 0.5f, 0);
    upload(context(), light.direct, std::as_bytes(std::span(direct)));

    Values albedo, source(n), emission(n, glm::dvec3(0));
    for (const glm::uvec2& a : downloadAs<glm::uvec2>(context(), w.facets.albedo)) albedo.emplace_back(unpackAlbedo(a));
    if (w.facets.hasEmission) {
      const auto m = downloadAs<glm::vec3>(context(), w.facets.emission);
      std::copy_n(m.begin(), n, emission.begin());
    }
    for (uint32_t i = 0; i < n; ++i) source[i] = emission[i] + albedo[i] * glm::dvec3(direct[i]);

    Values b = source;
    std::vector<Values> h;
    Values emitted(n, glm::dvec3(0));
    for (uint32_t k = 0; k < 3; ++k) {
      Settings own = settings;
      own.matrix.gpu = raysOfFrame(settings.matrix.gpu, k);
      EXPECT_EQ(own.matrix.gpu == settings.matrix.gpu, k == 0);
      const FormFactors m = buildMatrix(context(), w.facets, w.field, own);
      const std::vector<HostRow> rows = hostRows(context(), m);
      h.push_back(product(rows, b));
      if (under) {
        Lighting other = makeLighting(context(), w.facets, byMatrix(settings));
        Frame frame = context().begin();
        gatherSky(frame, m, sky.bins, other);
        frame.submitAndWait();
        const Values s = values(other.sky, n);
        for (uint32_t i = 0; i < n; ++i) h[k][i] += s[i];
      }
      const Values fm = product(rows, emission);
      for (uint32_t i = 0; i < n; ++i) {
        b[i] = source[i] + albedo[i] * h[k][i];
        emitted[i] += fm[i] * double((k + 1) * (k + 1)) / 14.0;
      }
    }
    for (uint32_t frames = 1; frames <= 3; ++frames) {
      const SolveReport report =
          bruteForce(context(), w.facets, w.field, sky, light, settings, 1, /*restarts=*/frames == 1);
      EXPECT_EQ(report.frames, frames);
      double weights = 0, squares = 0;
      for (double k = 1; k <= frames; ++k) weights += k * k, squares += k * k * k * k;
      Values mean(n, glm::dvec3(0)), error(n, glm::dvec3(0)), radiosity(n);
      for (uint32_t i = 0; i < n; ++i) {
        for (uint32_t k = 0; k < frames; ++k) mean[i] += h[k][i] * (double((k + 1) * (k + 1)) / weights);
        for (uint32_t k = 0; k < frames; ++k)
          error[i] += double((k + 1) * (k + 1)) * (h[k][i] - mean[i]) * (h[k][i] - mean[i]);
        if (frames > 1)
          error[i] = glm::sqrt(error[i] / (weights - squares / weights) * (squares / (weights * weights)));
        radiosity[i] = source[i] + albedo[i] * mean[i];
      }
      expectNear(values(light.indirect, n), mean, 2e-6, "H");
      expectNear(values(light.radiosity, n), radiosity, 2e-6, "B");
      if (frames > 1) expectNear(values(light.frameMean.standardError, n), error, 1e-5, "standard error");
    }
    if (w.facets.hasEmission) expectNear(values(light.emitted, n), emitted, 2e-6, "F M");
    EXPECT_TRUE(light.report.atMostFrames && light.report.settled());
    EXPECT_FALSE(light.frameMean.hits) << "scratch that is kept";
  }
}

TEST_F(BruteForce, TheSameBitsInOneGoAndFrameByFrame) {
  const Settings settings = framewise(8, 16, 6);
  const auto atOnce = prepared(room(), settings);
  EXPECT_EQ(atOnce->lighting().report.frames, 6u);
  EXPECT_TRUE(atOnce->asleep());
  Pipeline window(context(), room(), settings);
  for (uint32_t frames = 1; frames <= 6; ++frames) {
    EXPECT_FALSE(window.asleep());
    window.prepare({}, settings.solver.sweepsPerFrame);
    EXPECT_EQ(window.lighting().report.frames, frames);
  }
  EXPECT_TRUE(window.asleep());
  EXPECT_TRUE(bits(window) == bits(*atOnce));
  // Idle: nothing is dispatched.
  const uint64_t before = gpu().device->counters.dispatches;
  window.prepare({}, settings.solver.sweepsPerFrame);
  EXPECT_EQ(gpu().device->counters.dispatches, before);
  // A capture is of the light that a headless run has.
  window.solvedAfresh({}, [&] { EXPECT_TRUE(bits(window) == bits(*atOnce)); });
  // More frames go on with the mean.
  const auto longer = prepared(room(), framewise(8, 16, 10));
  window.set(framewise(8, 16, 10));
  EXPECT_FALSE(window.asleep());
  window.prepare();
  EXPECT_EQ(window.lighting().report.sweeps, 4u);
  EXPECT_TRUE(bits(window) == bits(*longer));
  // Relighting in every frame takes none from the mean.
  Settings always = framewise(8, 16, 12);
  always.effects.relight = EffectMode::on;
  window.set(always);
  window.prepare({}, 1);
  EXPECT_EQ(window.lighting().report.frames, 11u);
  // Fewer begin anew.
  window.set(settings);
  window.prepare();
  EXPECT_TRUE(bits(window) == bits(*atOnce));
}

TEST_F(BruteForce, AnotherLightBeginsAnew) {
  const Settings settings = framewise(8, 16, 5);
  Scene dim = room();
  ASSERT_FALSE(dim.lights.empty());
  dim.lights[0].intensity *= 0.5f;
  const auto expected = prepared(dim, settings);
  Pipeline pipeline(context(), room(), settings);
  pipeline.prepare();
  pipeline.setLights(dim.lights);
  EXPECT_FALSE(pipeline.asleep());
  pipeline.prepare({}, 1);
  EXPECT_EQ(pipeline.lighting().report.frames, 1u);
  pipeline.prepare();
  EXPECT_TRUE(bits(pipeline) == bits(*expected));
  // So does another gain, and the dark is dark.
  Settings gained = settings;
  gained.solver.gpu.lambda = 0.5f;
  pipeline.set(gained);
  pipeline.prepare({}, 1);
  EXPECT_EQ(pipeline.lighting().report.frames, 1u);
  Settings dark = settings;
  dark.effects.emission = dark.effects.sun = dark.effects.point = EffectMode::off;
  dark.effects.matrix = EffectMode::on;
  pipeline.set(dark);
  pipeline.prepare();
  EXPECT_TRUE(pipeline.lighting().report.dark && pipeline.asleep());
  for (const glm::dvec3& h : values(pipeline.lighting().indirect, pipeline.facets().count)) ASSERT_EQ(h, glm::dvec3(0));
}

TEST_F(BruteForce, TheLightOfBeforeIsShownForTheFirstFrames) {
  const Settings settings = framewise(8, 16, 20);
  const Scene lit = room();
  Scene dim = lit;
  dim.lights[0].intensity *= 0.5f;
  const auto expected = prepared(dim, settings);
  Pipeline window(context(), lit, settings);
  window.prepare();
  const uint32_t n = window.facets().count;
  const Lighting& light = window.lighting();
  const Values before = values(light.shaded(), n);
  window.setLights(dim.lights);
  for (uint32_t frame = 1; frame < 8; ++frame) {
    window.prepare({}, 1);
    EXPECT_EQ(light.report.frames, frame);
    EXPECT_EQ(values(light.shaded(), n), before);
  }
  window.prepare({}, 1);
  EXPECT_FALSE(light.frameMean.held || light.frameMean.heldEmitted);
  EXPECT_NE(values(light.shaded(), n), before);
  // No part of it comes into the mean.
  window.prepare();
  EXPECT_TRUE(bits(window) == bits(*expected));
  // While a light is dragged the new light is shown after as many frames, and headless at once.
  for (uint32_t frame = 1; frame <= 8; ++frame) {
    EXPECT_EQ(static_cast<bool>(light.frameMean.held), frame > 1);
    window.setLights((frame % 2 == 0 ? dim : lit).lights);
    window.prepare({}, 1);
    EXPECT_EQ(light.report.frames, 1u);
  }
  EXPECT_FALSE(light.frameMean.held);
  window.prepare();
  window.setLights(lit.lights);
  window.prepare();
  EXPECT_FALSE(light.frameMean.held);
  // In the dark it is dark at once.
  Settings dark = settings;
  dark.effects.emission = dark.effects.sun = dark.effects.point = EffectMode::off;
  dark.effects.matrix = EffectMode::on;
  window.set(dark);
  window.prepare({}, 1);
  for (const glm::dvec3& h : values(window.lighting().shaded(), n)) ASSERT_EQ(h, glm::dvec3(0));
}

TEST_F(BruteForce, FurnaceIsItsClosedForm) {
  for (const double rho : {0.5, 0.9}) {
    Settings settings = framewise(8, 32, 400);
    settings.solver.tolerance = 5e-4f;
    const auto p = prepared(furnaceBox(static_cast<float>(rho)), settings);
    const SolveReport& report = p->lighting().report;
    const Values b = values(p->lighting().radiosity, p->facets().count);
    double mean = 0, least = 1e30;
    for (const glm::dvec3& x : b) mean += x.x / static_cast<double>(b.size()), least = std::min(least, x.x);
    fmt::print("rho {}: {} frames, B (1 - rho) mean {:.6f} least {:.6f}, standard error {:.2g} of {:.4g}\n", rho,
               report.frames, mean * (1 - rho), least * (1 - rho), report.standardError, report.meanH);
    EXPECT_TRUE(report.converged && !report.atMostFrames);
    EXPECT_LE(report.standardError, settings.solver.tolerance * report.meanH);
    EXPECT_NEAR(mean * (1 - rho), 1, 1e-3);
    EXPECT_GE(least * (1 - rho), 0.99);
  }
}

TEST_F(BruteForce, LightIsConserved) {
  // In an open room some escapes: what enters is what is absorbed and what escapes, as by the matrix's row sums.
  for (const bool open : {false, true}) {
    Settings settings = framewise(10, 64, 400);
    settings.solver.tolerance = 0.02f;
    const Scene scene = open ? stillLife().finish("still life") : lampRoom().finish("room");
    const auto frames = prepared(scene, settings), matrix = prepared(scene, byMatrix(settings));
    const std::optional<EnergyBalance> found = frames->lighting().report.energy,
                                       expected = matrix->lighting().report.energy;
    ASSERT_TRUE(found && expected && frames->lighting().report.converged);
    fmt::print("{}: {}; matrix: {}\n", open ? "open" : "closed", describe(*found, 1), describe(*expected, 1));
    EXPECT_NEAR(found->imbalance(), 0, 0.01);
    EXPECT_NEAR(found->entering.x / expected->entering.x, 1, 1e-5);
    EXPECT_NEAR(found->escaped.x, expected->escaped.x, 0.01 * expected->entering.x);
    EXPECT_EQ(found->escaped.x > 0.05 * found->entering.x, open);
  }
  // Not claimed before it is so, nor of light that a sky adds to.
  EXPECT_FALSE(prepared(room(), framewise(8, 16, 3))->lighting().report.energy);
}

TEST_F(BruteForce, TheInspectorHasTheStandardErrorInPlaceOfARow) {
  const auto p = prepared(room(), framewise(8, 16, 4));
  const Values h = values(p->lighting().indirect, p->facets().count),
               error = values(p->lighting().frameMean.standardError, p->facets().count);
  const Inspector inspector(context(), *p);
  const glm::uvec3 voxel = unpackVoxel(downloadAs<uint32_t>(context(), p->facets().voxel).front());
  const InspectedVoxel seen = inspector.voxel(voxel);
  ASSERT_FALSE(seen.facets.empty());
  for (const InspectedFacet& facet : seen.facets) {
    EXPECT_EQ(facet.irradiance, h[facet.facet]);
    EXPECT_EQ(facet.standardError, error[facet.facet]);
    EXPECT_GT(facet.standardError.x, 0);
    EXPECT_TRUE(facet.row.links.empty() && facet.column.links.empty());
    EXPECT_EQ(facet.residual, 0);
  }
}

class AgainstMatrix : public BruteForce {
 protected:
  /// A matrix has one set of rays for all bounces, so that its error is more than a frame's: it is taken from the
  /// spread of matrices of other seeds. One matrix, and the mean of them, are then as far from the mean over the frames
  /// as Student's distribution says: with 15 degrees of freedom 0.9 % of facets beyond 3 sigma, and of one matrix some
  /// more, whose light is not normally distributed where few rays meet what is bright.
  void agrees(const char* name, const Scene& scene, const Settings& settings) {
    constexpr uint32_t kMatrices = 16;
    const auto frames = prepared(scene, settings);
    const uint32_t n = frames->facets().count;
    const Lighting& light = frames->lighting();
    const Values mean = values(light.indirect, n), error = values(light.frameMean.standardError, n);
    const std::vector<float> area = downloadAs<float>(context(), frames->facets().area);
    Pipeline pipeline(context(), scene, byMatrix(settings));
    std::vector<Values> matrices;
    for (uint32_t k = 0; k <= kMatrices; ++k) {  // the first has the settings' own seed, and is not of the spread
      Settings other = byMatrix(settings);
      other.matrix.gpu.seed += k;
      pipeline.set(other);
      pipeline.prepare();
      ASSERT_EQ(pipeline.facets().count, n);
      matrices.push_back(values(pipeline.lighting().indirect, n));
    }
    double one = 0, all = 0, sum = 0;
    std::vector<double> sums(kMatrices + 1, 0);
    for (uint32_t i = 0; i < n; ++i) {
      double average = 0, variance = 0;
      for (uint32_t k = 1; k <= kMatrices; ++k) average += matrices[k][i].x / kMatrices;
      for (uint32_t k = 1; k <= kMatrices; ++k)
        variance += (matrices[k][i].x - average) * (matrices[k][i].x - average) / (kMatrices - 1);
      const double ofMean = error[i].x * error[i].x;
      one += std::abs(matrices[0][i].x - mean[i].x) > 3 * std::sqrt(variance + ofMean) ? 1.0 / n : 0;
      all += std::abs(average - mean[i].x) > 3 * std::sqrt(variance / kMatrices + ofMean) ? 1.0 / n : 0;
      for (uint32_t k = 0; k <= kMatrices; ++k) sums[k] += area[i] * (matrices[k][i].x - mean[i].x);
      sum += area[i] * mean[i].x;
    }
    const double average = std::accumulate(sums.begin() + 1, sums.end(), 0.0) / kMatrices;
    double variance = 0;
    for (uint32_t k = 1; k <= kMatrices; ++k) variance += (sums[k] - average) * (sums[k] - average) / (kMatrices - 1);
    // The mean's own: its frames are as many matrices as their weights say, less the noise of one set in every bounce.
    const double sigma = std::sqrt(variance * (1.0 / kMatrices + light.frameMean.weights.errorOfVariance()));
    fmt::print(
        "{}: {} facets, {} frames; beyond 3 sigma {:.2f} % with one matrix, {:.2f} % with the mean of {}; sum "
        "{:+.2f} %, of the mean {:+.2f} % with a sigma of {:.2f} %\n",
        name, n, light.report.frames, 100 * one, 100 * all, kMatrices, 100 * sums[0] / sum, 100 * average / sum,
        100 * sigma / sum);
    EXPECT_LT(one, 0.03);
    EXPECT_LT(all, 0.015);
    EXPECT_LT(std::abs(average), 3 * sigma);
    EXPECT_LT(std::abs(sums[0]), 3 * std::sqrt(variance + sigma * sigma));
  }
};

TEST_F(AgainstMatrix, Box) {
  agrees("box", box(), framewise(16, 64, 32));
}

TEST_F(AgainstMatrix, BoxByTheThesissRule) {
  Settings settings = framewise(16, 64, 32);
  settings.matrix.gpu.hitRule = HitRule::thesis;
  agrees("box, thesis", box(), settings);
}

TEST_F(AgainstMatrix, Sponza) {
  const auto scenes = sharedScenes();
  if (!scenes) GTEST_SKIP() << "Sponza lies beside the project, in ../shared/scenes, which is absent";
  agrees("sponza", loadScene(*scenes / "sponza/sponza_small_lit_m.glb"), framewise(16, 32, 16));
}

TEST_F(BruteForce, TheStandardErrorIsTheSpreadOfIndependentRuns) {
  constexpr uint32_t kRuns = 16;
  Settings settings = framewise(8, 16, 64);
  const World w = world(stillLife().finish("still life"), settings);  // lit by its lamp alone
  const uint32_t n = w.facets.count;
  std::vector<Values> runs[2];  // after 16 and 64 frames
  double told[2] = {};
  for (uint32_t run = 0; run < kRuns; ++run) {
    settings.matrix.gpu.seed = 100 + run;
    Lighting light = makeLighting(context(), w.facets, settings);
    for (const bool longer : {false, true}) {
      bruteForce(context(), w.facets, w.field, {}, light, settings, longer ? 48 : 16, /*restarts=*/!longer);
      runs[longer].push_back(values(light.indirect, n));
      for (const glm::dvec3& e : values(light.frameMean.standardError, n)) told[longer] += glm::dot(e, e) / kRuns;
    }
  }
  for (const bool longer : {false, true}) {
    double seen = 0;
    for (uint32_t i = 0; i < n; ++i) {
      glm::dvec3 mean(0);
      for (const Values& run : runs[longer]) mean += run[i] / double{kRuns};
      for (const Values& run : runs[longer]) seen += glm::dot(run[i] - mean, run[i] - mean) / (kRuns - 1);
    }
    fmt::print("{} frames: standard error {:.4g} (rms of {} facets), spread of {} runs {:.4g}\n", longer ? 64 : 16,
               std::sqrt(told[longer] / n), n, kRuns, std::sqrt(seen / n));
    EXPECT_NEAR(std::sqrt(seen / told[longer]), 1, 0.1);
  }
  EXPECT_NEAR(std::sqrt(told[1] / told[0]), 0.5, 0.05) << "does not fall as the root of the frames";
}

TEST_F(BruteForce, HoldsNoMatrixAndAMatrixHoldsNoFrames) {
  const auto holds = [&](auto wanted) {
    { context().begin().submitAndWait(); }  // collects what finished frames have retired
    return std::ranges::any_of(gpu().device->memory().rows(), wanted);
  };
  const auto ofMatrix = [](const MemoryRow& r) { return r.subsystem == Subsystem::Matrix; };
  const auto ofFrames = [](const MemoryRow& r) { return r.name == "standard error of H"; };
  const Settings settings = framewise(8, 16, 3);
  Pipeline pipeline(context(), room(), settings);
  pipeline.prepare();
  EXPECT_FALSE(pipeline.matrix());
  EXPECT_FALSE(holds(ofMatrix));
  EXPECT_TRUE(holds(ofFrames));
  const EffectPlan plan = pipeline.plan();
  EXPECT_TRUE(plan.off(Effect::matrix) && plan.on(Effect::bruteForce));
  EXPECT_GT(plan.row(Effect::matrix).bytesNotAllocated, 0u);
  EXPECT_NE(plan.row(Effect::matrix).reason.find("solver.method = brute_force"), std::string::npos);
  const std::vector<std::byte> before = bits(pipeline);

  const auto matrix = prepared(room(), byMatrix(settings));
  EXPECT_TRUE(matrix->plan().on(Effect::matrix) && matrix->plan().off(Effect::bruteForce));
  EXPECT_FALSE(matrix->lighting().frameMean.standardError);
  EXPECT_EQ(pipeline.set(byMatrix(settings)), Redo::Matrix);
  pipeline.prepare();
  EXPECT_TRUE(holds(ofMatrix));
  EXPECT_FALSE(holds(ofFrames));
  EXPECT_TRUE(bits(pipeline) == bits(*matrix));
  pipeline.set(settings);
  pipeline.prepare();
  EXPECT_TRUE(bits(pipeline) == before);
}

TEST_F(BruteForce, LightThatGrowsWithoutBoundIsStopped) {
  Settings settings = framewise(10, 32, 200);
  settings.solver.gpu.lambda = 1.5f;
  Pipeline pipeline(context(), furnaceBox(0.9f), settings);
  pipeline.prepare();
  const SolveReport& report = pipeline.lighting().report;
  EXPECT_TRUE(report.diverging && report.settled() && !report.converged);
  EXPECT_LT(report.frames, 40u);
  EXPECT_FALSE(pipeline.findings().empty());
  EXPECT_TRUE(pipeline.asleep());
}

TEST_F(BruteForce, ViewsSayWhatIsMissing) {
  const Settings settings = framewise(8, 16, 4), matrix = byMatrix(settings);
  for (const ViewInfo& info : views()) {
    EXPECT_EQ(whatIsMissing(info, settings).empty(), !info.isFrom(FROM_MATRIX | FROM_MATRIX_ROW | FROM_SKY))
        << info.name;
    EXPECT_EQ(whatIsMissing(info, matrix).empty(), !info.isFrom(FROM_STANDARD_ERROR | FROM_SKY)) << info.name;
  }
  const auto sum = [&](Pipeline& pipeline, View view) {
    Targets targets(context(), {32, 24});
    Frame frame = context().begin();
    pipeline.render(frame, pipeline.scene().cameras.at(0), view, targets);
    frame.submitAndWait();
    const auto bytes = download(context(), targets.linear);
    const std::span pixels(reinterpret_cast<const glm::vec4*>(bytes.data()), bytes.size() / sizeof(glm::vec4));
    return std::accumulate(pixels.begin(), pixels.end(), 0.0, [](double s, const glm::vec4& p) { return s + p.x; });
  };
  const auto frames = prepared(room(), settings), solved = prepared(room(), matrix);
  EXPECT_GT(sum(*frames, VIEW_STANDARD_ERROR), 0);
  EXPECT_EQ(sum(*frames, VIEW_ROW_SUM), 0);
  EXPECT_EQ(sum(*frames, VIEW_MATRIX_ROW), 0);
  EXPECT_EQ(sum(*solved, VIEW_STANDARD_ERROR), 0);
}

TEST(BruteForceCommands, SayThatThereIsNoMatrix) {
  const TemporaryFolder folder;
  const std::string out = folder.path.string();
  const auto with = [&](std::vector<std::string> more) {
    for (const char* setting :
         {"voxel.resolution=10", "matrix.rays=16", "solver.method=brute_force", "solver.frames=3"})
      more.insert(more.end(), {"--set", setting});
    more.insert(more.end(), {"--out", out});
    return runIrad(more);
  };
  const RunResult exported = with({"export", "box", "--matrix"});
  EXPECT_EQ(exported.status, 2);
  EXPECT_TRUE(contains(exported.err, "--matrix: solver.method = brute_force has no matrix")) << exported.err;
  const RunResult drawn = with({"render", "box", "--size", "16x12", "--view", "row-sum,standard-error"});
  EXPECT_EQ(drawn.status, 0) << drawn.err;
  EXPECT_TRUE(contains(drawn.err, "the view row-sum is empty. solver.method = brute_force")) << drawn.err;
  EXPECT_TRUE(contains(drawn.out, "brute force 3 frames of 16 rays per facet")) << drawn.out;
}

}  // namespace
}  // namespace irad::test::brute_force_suite
