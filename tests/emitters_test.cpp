// The first gather by samples of the emitters against that by rays (docs/method.md 5); against a closed form: `irad
// check tiny-emitter`.
#include "gi/emitters.h"
#include "gi/gather_emitters.h"
#include "gi/host_trace.h"
#include "gi/lighting.h"
#include "gi/matrix.h"
#include "gi/solve.h"
#include "tests/gi_fixture.h"

namespace irad::test::emitters_suite {
namespace {

class EmitterSamples : public GiTest {
 protected:
  std::vector<glm::vec4> values(const Buffer& buffer) { return downloadAs<glm::vec4>(context(), buffer); }
  /// A lamp near a wall, of 8 x 8 voxels at N = 32, whose light goes one way.
  static Scene lampInBox() {
    SceneBuilder b;
    const uint32_t m = b.material(glm::vec3(0.7f, 0.5f, 0.2f)), lamp = b.material(glm::vec3(0.1f), glm::vec3(3, 2, 1));
    b.box({m, m, m, m, m, m}, glm::vec3(-1), glm::vec3(1), /*inward=*/true);
    b.quad(lamp, {0.3f, 0.3f, 0.2f}, {0.8f, 0.3f, 0.2f}, {0.8f, 0.3f, 0.7f}, {0.3f, 0.3f, 0.7f});
    return b.finish("lamp");
  }
};

TEST_F(EmitterSamples, SamplesOfEmittersKeepTheMeanOfTheirRays) {
  // Both ways give the same light.
  Settings settings = at(32, 512);
  settings.matrix.emitterSamples = 128;
  const World w = world(lampInBox(), settings);
  const Emitters emitters = listEmitters(context(), w.facets);
  std::vector<double> mean;
  const FormFactors f = buildMatrix(context(), w.facets, w.field, settings);
  for (const EmitterSource& source : {EmitterSource{}, EmitterSource{&emitters, &w.field}}) {
    Lighting light = makeLighting(context(), w.facets, settings);
    gatherEmitters(context(), w.facets, f, source, settings, light);
    EXPECT_TRUE(solve(context(), w.facets, f, light, settings, 1000).converged);
    EXPECT_EQ(bool(light.correction), source.emitters != nullptr);
    double sum = 0;
    for (const glm::vec4& h : values(light.indirect)) sum += h.x;
    mean.push_back(sum / w.facets.count);
  }
  fmt::print("H by rays {:.5f}, by samples {:.5f}\n", mean[0], mean[1]);
  EXPECT_NEAR(mean[1] / mean[0], 1.0, 0.01);
}

TEST_F(EmitterSamples, AGainOnTheLightLeavesSamplesAndRaysApartByTheirNoiseAlone) {
  // H with the emitters sampled less H without, over lambda: F M by samples less F M by rays (what bounces adds
  // averages the noise of many facets), whatever lambda is.
  Settings settings = at(32, 128);
  settings.matrix.emitterSamples = 64;
  settings.solver.tolerance = 1e-5f;
  const World w = world(lampInBox(), settings);
  const Emitters emitters = listEmitters(context(), w.facets);
  // Where no emitter is near: there the samples leave its light to the rays.
  std::vector<size_t> far;
  const std::vector<uint32_t> voxel = downloadAs<uint32_t>(context(), w.facets.voxel);
  for (size_t i = 0; i < voxel.size(); ++i)
    if (unpackVoxel(voxel[i]).y < w.facets.grid.dims.y / 2) far.push_back(i);
  struct Found {
    std::vector<glm::vec4> irradiance, fromEmitters;  // H, F M
  };
  struct Pair {
    Found samples, rays;
  };
  const auto matrix = [&](uint32_t seed) {
    settings.matrix.gpu.seed = seed;
    return buildMatrix(context(), w.facets, w.field, settings);
  };
  const auto solved = [&](const FormFactors& f, float lambda) {
    settings.solver.gpu.lambda = lambda;
    const auto by = [&](const EmitterSource& source) {
      Lighting light = makeLighting(context(), w.facets, settings);
      gatherEmitters(context(), w.facets, f, source, settings, light);
      EXPECT_TRUE(solve(context(), w.facets, f, light, settings, 1000).converged);
      EXPECT_EQ(bool(light.correction), source.emitters != nullptr);
      return Found{values(light.indirect), values(light.emitted)};
    };
    return Pair{by({&emitters, &w.field}), by({})};
  };
  const auto meanSquare = [&](const std::vector<glm::vec4>& a, const std::vector<glm::vec4>& b) {
    double sum = 0;
    for (const size_t i : far) sum += std::pow(double{a[i].z} - double{b[i].z}, 2);  // least of it bounces: albedo .2
    return sum / static_cast<double>(far.size());
  };

  // Each one's noise: half the mean square by which the F M of two seeds differ.
  const Pair two = solved(matrix(2), 1);
  const FormFactors f = matrix(1);
  const Pair one = solved(f, 1);
  const double bySamples = meanSquare(one.samples.fromEmitters, two.samples.fromEmitters) / 2,
               byRays = meanSquare(one.rays.fromEmitters, two.rays.fromEmitters) / 2;
  const double noise = std::sqrt(bySamples + byRays);
  // The root mean square of n values is known to 1 / sqrt(2 n) of it, and two are compared: four standard deviations.
  const double tolerance = 4 / std::sqrt(static_cast<double>(far.size()));
  fmt::print("noise of F M at {} facets: by samples {:.5f}, by rays {:.5f} W/m^2; tolerance {:.3f} of both\n",
             far.size(), std::sqrt(bySamples), std::sqrt(byRays), tolerance);
  for (const float lambda : {0.5f, 0.8f, 1.0f, 1.2f}) {
    const Pair pair = solved(f, lambda);
    const double apart = std::sqrt(meanSquare(pair.samples.irradiance, pair.rays.irradiance)) / lambda;
    fmt::print("lambda {}: H / lambda by samples and by rays apart by {:.3f} of their noise\n", lambda, apart / noise);
    EXPECT_NEAR(apart / noise, 1, tolerance) << lambda;
  }
}

TEST_F(EmitterSamples, AGainOnTheLightIsOneOnTheAlbedos) {
  // With B = lambda B', H = lambda H': B' = M + lambda rho H', H' = F B' + F M by samples - F M by rays.
  Settings settings = at(16, 128);
  settings.solver.tolerance = 1e-6f;
  const World w = world(lampInBox(), settings);
  const Emitters emitters = listEmitters(context(), w.facets);
  const FormFactors f = buildMatrix(context(), w.facets, w.field, settings);
  const auto solved = [&](float lambda, float rho) {
    const std::vector<glm::uvec2> albedo(w.facets.count, packAlbedo(glm::vec3(rho)));
    upload(context(), w.facets.albedo, std::as_bytes(std::span(albedo)));
    settings.solver.gpu.lambda = lambda;
    Lighting light = makeLighting(context(), w.facets, settings);
    gatherEmitters(context(), w.facets, f, {&emitters, &w.field}, settings, light);
    EXPECT_TRUE(solve(context(), w.facets, f, light, settings, 1000).converged);
    EXPECT_TRUE(light.correction);
    return values(light.indirect);
  };
  for (const float lambda : {0.5f, 0.8f, 1.2f}) {
    const std::vector<glm::vec4> h = solved(lambda, 0.5f), scaled = solved(1, lambda * 0.5f);
    for (size_t i = 0; i < h.size(); ++i)
      for (int c = 0; c < 3; ++c)
        // Albedos are stored to half of 1 / 65535, which is 3e-5 of .25 at most; the solver stops at 1e-6 of the
        // largest H, about 1 W/m^2.
        ASSERT_NEAR(h[i][c] / lambda, scaled[i][c], 1e-4f * scaled[i][c] + 1e-5f) << lambda << ", facet " << i;
  }
}

TEST_F(EmitterSamples, SamplesThatLoseLightAreNotUsed) {
  // The end of a corridor shines; the table of emitters does not know half of it.
  Settings settings = at(16, 256);
  SceneBuilder b;
  const uint32_t m = b.material(glm::vec3(0.5f)), lamp = b.material(glm::vec3(0.1f), glm::vec3(30));
  b.box({m, m, m, m, m, lamp}, glm::vec3(-0.3f, -0.3f, -1), glm::vec3(0.3f, 0.3f, 1), /*inward=*/true);
  const World w = world(b.finish("corridor"), settings);
  const std::vector<glm::vec3> exitance = downloadAs<glm::vec3>(context(), w.facets.emission);
  std::vector<glm::vec3> half = exitance;
  for (size_t i = 0; i < half.size(); i += 2) half[i] = glm::vec3(0);
  upload(context(), w.facets.emission, std::as_bytes(std::span(half)));
  const Emitters emitters = listEmitters(context(), w.facets);
  upload(context(), w.facets.emission, std::as_bytes(std::span(exitance)));
  const FormFactors f = buildMatrix(context(), w.facets, w.field, settings);
  const auto solved = [&](EffectMode sampling) {
    settings.matrix.emitterSampling = sampling;
    Lighting light = makeLighting(context(), w.facets, settings);
    gatherEmitters(context(), w.facets, f, {&emitters, &w.field}, settings, light);
    EXPECT_TRUE(solve(context(), w.facets, f, light, settings, 1000).converged);
    return light;
  };
  const Lighting automatic = solved(EffectMode::automatic), rays = solved(EffectMode::off);
  fmt::print("corridor: samples see {:.3f} of the rays' light\n", automatic.sampledShare);
  ASSERT_LT(automatic.sampledShare, 0.9f);
  EXPECT_FALSE(automatic.correction);
  EXPECT_EQ(values(automatic.emitted), values(rays.emitted));
  EXPECT_EQ(values(automatic.indirect), values(rays.indirect));
}

TEST_F(EmitterSamples, TheHostFindsWhatTheKernelFinds) {
  if (!canTraceOnHost()) GTEST_SKIP() << "built without IRAD_EMBREE";
  if (!context().device.isCpu) GTEST_SKIP() << "the kernel samples the emitters on GPUs";
  // Past a ball, through a mask of vertices' alpha and a pane that tints.
  SceneBuilder b;
  const uint32_t m = b.material(glm::vec3(0.7f, 0.5f, 0.2f)), lamp = b.material(glm::vec3(0.1f), glm::vec3(3, 2, 1)),
                 pane = b.material(glm::vec3(0.9f, 0.5f, 0.2f)), veil = b.material(glm::vec3(0.6f));
  b.box({m, m, m, m, m, m}, glm::vec3(-1), glm::vec3(1), /*inward=*/true);
  b.quad(lamp, {0.3f, 0.9f, 0.2f}, {0.8f, 0.9f, 0.2f}, {0.8f, 0.9f, 0.7f}, {0.3f, 0.9f, 0.7f});
  b.sphere(m, glm::vec3(-0.4f, -0.3f, -0.2f), 0.35f, /*inward=*/false, 12);
  b.quad(pane, {-1, 0.52f, 1}, {0.2f, 0.53f, 1}, {0.2f, 0.55f, -1}, {-1, 0.54f, -1});
  b.quad(veil, {0, -0.1f, 1}, {1, -0.11f, 1}, {1, -0.15f, -1}, {0, -0.14f, -1});
  b.edit(pane).transmission = 0.9f;
  b.edit(veil).alpha = AlphaMode::Blend;
  b.edit(veil).baseColor.a = 0.4f;
  const World w = world(b.finish("veils"), at(24, 64));
  const Emitters emitters = listEmitters(context(), w.facets);
  const FormFactors f = buildMatrix(context(), w.facets, w.field, w.settings);
  const auto found = [&](bool onHost) {
    Lighting light = makeLighting(context(), w.facets, w.settings);
    gatherEmitters(context(), w.facets, f, {&emitters, &w.field, onHost}, w.settings, light);
    EXPECT_TRUE(light.correction);
    return values(light.emitted);
  };
  const std::vector<glm::vec4> host = found(true), kernel = found(false);
  EXPECT_EQ(host, found(true)) << "the same bits twice";
  size_t differ = 0;
  glm::dvec4 byHost(0), byKernel(0);
  for (size_t i = 0; i < host.size(); ++i) {
    byHost += host[i];
    byKernel += kernel[i];
    // A ray of 128 that ends otherwise changes more than this.
    differ += glm::length(glm::vec3(host[i] - kernel[i])) > 1e-4f * glm::length(glm::vec3(kernel[i])) + 1e-6f;
  }
  fmt::print(
      "F M of {} of {} facets differs between host and kernel; sums apart by {:.2g} {:.2g} {:.2g}, variance {:.2g}\n",
      differ, host.size(), byHost.x / byKernel.x - 1, byHost.y / byKernel.y - 1, byHost.z / byKernel.z - 1,
      byHost.w / byKernel.w - 1);
  EXPECT_LT(differ, host.size() / 50) << "ties alone";
  for (int c = 0; c < 4; ++c) EXPECT_NEAR(byHost[c] / byKernel[c], 1, 1e-3) << c;

  // The threads that share the work do not show.
  const auto table = downloadAs<Emitter>(context(), emitters.entries);
  const auto exitance = downloadAs<glm::vec3>(context(), w.facets.emission);
  const auto trace = makeHostTrace(context(), w.facets);
  std::vector<glm::vec4> one(w.facets.count), three(w.facets.count);
  trace->emitters({table, emitters.power, exitance, 32, 1}, one, /*threads=*/1);
  trace->emitters({table, emitters.power, exitance, 32, 1}, three, /*threads=*/3);
  EXPECT_EQ(one, three);
}

}  // namespace
}  // namespace irad::test::emitters_suite
