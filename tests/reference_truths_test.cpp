// `irad reference`: the truths against closed forms, against each other and against Cycles; files that go on, end early
// and are refused. (What the path tracer alone is held to is in path_tracer_test.cpp.)
#include <signal.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <fstream>
#include <nlohmann/json.hpp>
#include <numbers>
#include <thread>

#include "gi/check/exact_solve.h"
#include "gi/check/path_state.h"
#include "gi/check/process.h"
#include "gi/check/scenes.h"
#include "gi/facets.h"
#include "gi/host_facets.h"
#include "gi/lighting.h"
#include "gi/matrix.h"
#include "gi/pipeline.h"
#include "renderer/base/error.h"
#include "renderer/base/image_io.h"
#include "tests/support.h"
#ifdef IRAD_OIIO
#include "tests/exr.h"
#endif

namespace irad::test::reference_truths_suite {
namespace {

namespace fs = std::filesystem;
using Words = std::vector<std::string>;

Words plus(Words words, const Words& more) {
  words.insert(words.end(), more.begin(), more.end());
  return words;
}

// ---- The matrix in double precision ----

class ExactSolve : public GpuTest {
 protected:
  static Settings at(uint32_t resolution, uint32_t rays) {
    Settings settings = defaultSettings(/*cpuDevice=*/true);
    settings.voxel.resolution = resolution;
    settings.matrix.gpu.rays = rays;
    settings.effects.matrix = EffectMode::on;
    return settings;
  }
};

TEST_F(ExactSolve, AFurnaceIsExact) {
  // Rows of 64 rays sum to 1 to the bit, and of 8, so that B = M / (1 - rho) with the albedo as it is stored. The last
  // list is long enough for several threads.
  for (const auto& [rho, resolution, rays] : {std::tuple(0.5f, 12u, 64u), {0.9f, 12u, 64u}, {0.5f, 80u, 8u}}) {
    Pipeline pipeline(context(), furnaceBox(rho), at(resolution, rays));
    pipeline.prepare();
    const ExactLight light = solveExactly(context(), pipeline, 1e-12);
    const HostFacets facets = hostFacets(context(), pipeline.facets());
    ASSERT_GT(facets.count(), resolution == 80 ? 32'768u : 0u);
    for (size_t i = 0; i < facets.count(); ++i) {
      const double m = facets.emission[i].x, a = facets.albedo[i].x;
      ASSERT_NEAR(light.radiosity[i].x, m / (1 - a), 2e-12 * m / (1 - a)) << i;
      ASSERT_NEAR(light.indirect[i].x, m / (1 - a), 2e-12 * m / (1 - a)) << i;
    }
    EXPECT_LE(light.bound, 1e-12 * light.meanH);
  }
}

TEST_F(ExactSolve, EndsWhereItsProgressSaysSo) {
  Pipeline pipeline(context(), furnaceBox(0.5f), at(12, 16));
  pipeline.prepare();
  // While rows are read, and within a sweep.
  for (const int last : {1, 2, 3}) {
    int asked = 0;
    EXPECT_THROW(solveExactly(context(), pipeline, 1e-12, [&](float) { return ++asked < last; }), WorkError);
    EXPECT_EQ(asked, last);
  }
}

/// By how much any facet's H is off, in any channel.
double errorOf(Context& context, const Pipeline& pipeline, const ExactLight& light) {
  const std::vector<glm::vec3> h = perFacet(context, pipeline.facets(), pipeline.lighting().indirect);
  double error = 0;
  for (size_t i = 0; i < h.size(); ++i)
    for (int c = 0; c < 3; ++c) error = std::max(error, std::abs(h[i][c] - light.indirect[i][c]));
  return error;
}

TEST_F(ExactSolve, TheSolverIsWithinItsBound) {
  // Lamps, points, spots; emitters that are sampled.
  for (const SolverAcceleration acceleration : {SolverAcceleration::off, SolverAcceleration::anderson})
    for (const float tolerance : {1e-2f, 1e-4f}) {
      Settings settings = at(16, 96);
      settings.solver.acceleration = acceleration;
      settings.solver.tolerance = tolerance;
      Pipeline pipeline(context(), mixedRoom(), settings);
      pipeline.prepare();
      const SolveReport& report = pipeline.lighting().report;
      ASSERT_TRUE(report.converged);
      const ExactLight light = solveExactly(context(), pipeline, 1e-12);
      const double error = errorOf(context(), pipeline, light);
      printf("tolerance %g: off by %.3g, bound %.3g, mean H %.4g\n", tolerance, error, report.bound, light.meanH);
      EXPECT_LE(error, report.bound + 1e-6 * report.largestH);
      EXPECT_NEAR(report.meanH, light.meanH, report.bound + 1e-6 * light.meanH);
    }
}

/// The mixed room, its ball of glass that tints: rows hold some columns several times, with other channels left.
Scene withTintedBall() {
  Scene scene = mixedRoom();
  Material& ball = scene.materials.back();
  ball.baseColor = glm::vec4(0.9f, 0.5f, 0.2f, 1);
  ball.metallic = 0;
  ball.transmission = 0.9f;
  ball.doubleSided = true;
  return scene;
}

TEST_F(ExactSolve, PanesThatTintAreInTheEquation) {
  Settings settings = at(16, 96);
  settings.solver.tolerance = 1e-4f;
  Pipeline pipeline(context(), withTintedBall(), settings);
  pipeline.prepare();
  ASSERT_TRUE(pipeline.matrix().tinted);
  const SolveReport& report = pipeline.lighting().report;
  ASSERT_TRUE(report.converged);
  const ExactLight light = solveExactly(context(), pipeline, 1e-12);
  const double error = errorOf(context(), pipeline, light);
  printf("off by %.3g, bound %.3g, mean H %.4g\n", error, report.bound, light.meanH);
  EXPECT_LE(error, report.bound + 1e-6 * report.largestH);
}

TEST_F(ExactSolve, BouncesOfAFurnaceAreAGeometricSeries) {
  Pipeline pipeline(context(), furnaceBox(0.7f), at(12, 64));
  pipeline.prepare();
  const ExactLight light = solveExactly(context(), pipeline, 1e-12, {}, 6);
  ASSERT_EQ(light.bounces.size(), 6u);
  const HostFacets facets = hostFacets(context(), pipeline.facets());
  for (size_t i = 0; i < facets.count(); ++i)
    for (size_t k = 0; k < 6; ++k) {
      const double known = facets.emission[i].x * std::pow(double{facets.albedo[i].x}, static_cast<double>(k));
      ASSERT_NEAR(light.bounces[k][i].x, known, 1e-12 * known) << k;
    }
}

TEST_F(ExactSolve, BouncesAddUpToTheLight) {
  // Lamps, points, spots; emitters that are sampled.
  Pipeline pipeline(context(), mixedRoom(), at(12, 96));
  pipeline.prepare();
  const ExactLight light = solveExactly(context(), pipeline, 1e-12, {}, 300);
  double off = 0, first = 0;
  for (size_t i = 0; i < light.indirect.size(); ++i) {
    glm::dvec3 sum(0);
    for (const auto& bounce : light.bounces) sum += bounce[i];
    for (int c = 0; c < 3; ++c) {
      off = std::max(off, std::abs(sum[c] - light.indirect[i][c]));
      first = std::max(first, std::abs(light.bounces[0][i][c] - light.indirect[i][c]));
    }
  }
  printf("the sum of 300 is off by %.3g of mean H %.4g, the first alone by %.3g\n", off, light.meanH, first);
  EXPECT_LE(off, 1e-10 * light.meanH);
  EXPECT_GT(first, 0.1 * light.meanH);
}

TEST_F(ExactSolve, WhatIsShownIsWhatWasPut) {
  Pipeline pipeline(context(), furnaceBox(0.5f), at(12, 16));
  pipeline.prepare();
  const std::vector<glm::vec4> h(pipeline.facets().count, glm::vec4(3, 2, 1, 0));
  const Revision before = pipeline.revision();
  pipeline.showLight(h, {});
  EXPECT_NE(pipeline.revision(), before);
  for (const glm::vec3& v : perFacet(context(), pipeline.facets(), pipeline.lighting().shaded()))
    for (int c = 0; c < 3; ++c) EXPECT_NEAR(v[c], 3 - c, 1e-5);
}

// ---- Triangles ----

class Truths : public ::testing::Test {
 protected:
  void SetUp() override {
    if (!hasPathTracer()) GTEST_SKIP() << "this build has no path tracer (IRAD_EMBREE)";
  }
  TemporaryFolder folder_;
  std::string file(const char* name) const { return (folder_.path / name).string(); }
  nlohmann::json truth(const char* manifest) const {
    return nlohmann::json::parse(slurp(folder_.path / manifest)).at("truth");
  }
  Words small(const char* out, const Words& more = {}) const {
    return plus({"reference", "box", "--of", "triangles", "--size", "24x16", "--out", file(out)}, more);
  }
};

TEST_F(Truths, AnIntegratingSphere) {
  // I = 10 cd in the middle of a sphere of radius 2, rho = .7: E = I / r^2, B = rho E / (1 - rho) everywhere.
  SceneBuilder b;
  b.sphere(b.material(glm::vec3(0.7f)), glm::vec3(0), 2, /*inward=*/true, /*rings=*/256);
  Scene scene = b.finish("sphere");
  scene.lights = {{.type = LightType::Point, .position = scene.origin, .intensity = 10}};
  const Camera camera{.position = scene.origin + glm::dvec3(0.5, 0.3, 0), .yfov = 1.5f, .znear = 0.01f};
  const TracedPicture p = makePathTracer(scene)->render(camera, {24, 24}, {.samples = 256});
  const double expected = 0.7 * 2.5 / 0.3 / std::numbers::pi;
  printf("integrating sphere: %.6g +- %.2g, expected %.6g\n", p.lit.pictureMean.x, p.lit.pictureError.x, expected);
  // The chords of 256 rings lie within 1 - cos(pi / 512) of the sphere.
  EXPECT_NEAR(p.lit.pictureMean.x, expected, 3 * p.lit.pictureError.x + 1e-4 * expected);
  EXPECT_LT(p.lit.pictureError.x, 0.003 * expected);
}

#ifdef IRAD_OIIO
TEST_F(Truths, ThePictureHasItsErrorAsALayer) {
  ASSERT_EQ(runIrad(small("a.exr", {"--spp", "8", "--layer", "indirect,lit", "--seed", "7"})).status, 0);
  const Scene scene = loadScene(assets() / "box.glb");
  const TracedPicture p = makePathTracer(scene)->render(scene.cameras.at(0), {24, 16}, {.samples = 8, .seed = 7});
  const auto expectSame = [&](const std::vector<glm::vec3>& layer, const std::vector<glm::dvec3>& expected) {
    ASSERT_EQ(layer.size(), expected.size());
    for (size_t i = 0; i < layer.size(); ++i) EXPECT_EQ(layer[i], glm::vec3(expected[i])) << i;
  };
  expectSame(readExr(file("a.exr"), "error").pixels, p.indirect.error);
  expectSame(readExr(file("a.exr"), "lit").pixels, p.lit.mean);
  expectSame(readExr(file("a.exr"), "lit.error").pixels, p.lit.error);
  // What --reference reads is the first layer.
  const LinearPicture first = readLinear(file("a.exr"));
  for (size_t i = 0; i < first.pixels.size(); ++i) EXPECT_EQ(glm::vec3(first.pixels[i]), glm::vec3(p.indirect.mean[i]));
  const nlohmann::json truth = this->truth("a.json");
  EXPECT_EQ(truth.at("rays"), p.rays);
  EXPECT_EQ(truth.at("samples_per_pixel"), 8);
  EXPECT_EQ(truth.at("layers"), nlohmann::json({"indirect", "lit"}));
}

TEST_F(Truths, GlossyMaterialsAndBouncesAreLayers) {
  const RunResult run =
      runIrad(small("a.exr", {"--spp", "8", "--glossy", "--layer", "lit,specular", "--bounces", "2"}));
  ASSERT_EQ(run.status, 0) << run.err;
  const Scene scene = loadScene(assets() / "box.glb");
  const TracedPicture p = makePathTracer(scene)->render(scene.cameras.at(0), {24, 16},
                                                        {.samples = 8, .seed = 0, .glossy = true, .bounces = 3});
  const auto expectSame = [&](const char* layer, const std::vector<glm::dvec3>& expected) {
    const std::vector<glm::vec3> pixels = readExr(file("a.exr"), layer).pixels;
    ASSERT_EQ(pixels.size(), expected.size());
    for (size_t i = 0; i < pixels.size(); ++i) EXPECT_EQ(pixels[i], glm::vec3(expected[i])) << layer << i;
  };
  expectSame("specular", p.specular.mean);
  expectSame("specular.error", p.specular.error);
  expectSame("bounce.0", p.bounces[0].mean);
  expectSame("bounce.2", p.bounces[2].mean);
  expectSame("bounce.2.error", p.bounces[2].error);
  const nlohmann::json truth = this->truth("a.json");
  EXPECT_EQ(truth.at("materials"), "glossy");
  EXPECT_EQ(truth.at("bounces").at(1).at("mean").at(0), p.bounces[1].pictureMean.x);
  EXPECT_TRUE(contains(run.out, "bounce.2 ") && contains(run.out, "% of lit") && contains(run.out, "the rest"))
      << run.out;
}
#endif

TEST_F(Truths, ARunThatGoesOnGivesTheBitsOfOne) {
  ASSERT_EQ(runIrad(small("one.exr", {"--spp", "13"})).status, 0);
  ASSERT_EQ(runIrad(small("two.exr", {"--spp", "5"})).status, 0);
  EXPECT_NE(slurp(file("one.exr")), slurp(file("two.exr")));
  const RunResult second = runIrad(small("two.exr", {"--spp", "13", "--resume"}));
  ASSERT_EQ(second.status, 0) << second.err;
  EXPECT_TRUE(contains(second.out, "13 per pixel, 5 of them by earlier runs")) << second.out;
  EXPECT_EQ(slurp(file("one.exr")), slurp(file("two.exr")));
  EXPECT_EQ(readSums(file("one.state")).sums.lit, readSums(file("two.state")).sums.lit);
  EXPECT_EQ(truth("one.json").at("rays"), truth("two.json").at("rays"));
  // The manifest repeats the run.
  ASSERT_EQ(runIrad({"reference", "--config", file("one.json"), "--of", "triangles", "--spp", "13", "--out",
                     file("three.exr")})
                .status,
            0);
  EXPECT_EQ(slurp(file("one.exr")), slurp(file("three.exr")));
}

TEST_F(Truths, GlossyMaterialsGoOnToo) {
  const Words kind{"--glossy", "--bounces", "1"};
  ASSERT_EQ(runIrad(small("one.exr", plus({"--spp", "9"}, kind))).status, 0);
  ASSERT_EQ(runIrad(small("two.exr", plus({"--spp", "4"}, kind))).status, 0);
  ASSERT_EQ(runIrad(small("two.exr", plus({"--spp", "9", "--resume"}, kind))).status, 0);
  EXPECT_EQ(slurp(file("one.exr")), slurp(file("two.exr")));
  const RunResult diffuse = runIrad(small("two.exr", {"--spp", "16", "--resume", "--bounces", "1"}));
  EXPECT_EQ(diffuse.status, 2);
  EXPECT_TRUE(contains(diffuse.err, "materials \"glossy\", not \"diffuse\"")) << diffuse.err;
  const RunResult seen = runIrad(small("two.exr", {"--spp", "16", "--resume", "--bounces", "1", "--glossy-seen"}));
  EXPECT_EQ(seen.status, 2);
  EXPECT_TRUE(contains(seen.err, "materials \"glossy\", not \"glossy-seen\"")) << seen.err;
  // The manifest repeats it.
  ASSERT_EQ(runIrad(plus({"reference", "--config", file("one.json"), "--of", "triangles", "--spp", "9", "--out",
                          file("three.exr")},
                         kind))
                .status,
            0);
  EXPECT_EQ(slurp(file("one.exr")), slurp(file("three.exr")));
}

TEST_F(Truths, AStateOfAnotherPictureIsRefused) {
  ASSERT_EQ(runIrad(small("a.exr", {"--spp", "4"})).status, 0);
  const std::string state = slurp(file("a.state"));
  struct Case {
    Words more;
    const char* expected;
  };
  for (const Case& c :
       {Case{{"--seed", "3"}, "seed 0, not 3"}, Case{{"--glossy"}, "materials \"diffuse\", not \"glossy\""},
        Case{{"--bounces", "2"}, "bounces \"none\", not 2"}, Case{{"--centred"}, "centred false, not true"},
        Case{{"--set", "sky.source=constant"}, "sky.source \"none\", not \"constant\""},
        Case{{"--set", "scene.double_sided=true"}, "scene.double_sided \"false\", not \"true\""},
        Case{{"--camera", R"({"position": [0, 1, 3], "target": [0, 1, 0]})"}, ": camera {"}}) {
    const RunResult run = runIrad(small("a.exr", plus({"--spp", "8", "--resume"}, c.more)));
    EXPECT_EQ(run.status, 2) << run.err;
    EXPECT_TRUE(contains(run.err, "a.state is of another picture: ")) << run.err;
    EXPECT_TRUE(contains(run.err, c.expected)) << run.err;
  }
  const RunResult size = runIrad(
      {"reference", "box", "--of", "triangles", "--size", "24x17", "--out", file("a.exr"), "--spp", "8", "--resume"});
  EXPECT_EQ(size.status, 2);
  EXPECT_TRUE(contains(size.err, "size 24x16, not 24x17")) << size.err;
  EXPECT_EQ(slurp(file("a.state")), state) << "a refused run leaves it alone";
  const auto expectUnread = [&](const std::string& bytes, const char* expected) {
    std::ofstream(file("a.state"), std::ios::binary) << bytes;
    const RunResult run = runIrad(small("a.exr", {"--spp", "8", "--resume"}));
    EXPECT_EQ(run.status, 3) << run.err;
    EXPECT_TRUE(contains(run.err, "a.state") && contains(run.err, expected)) << run.err;
  };
  std::string damaged = state;
  damaged[damaged.size() - 100] ^= 1;
  expectUnread(damaged, "is damaged");
  expectUnread(state.substr(0, state.size() - 8), "bytes of sums in place of");
  expectUnread(state.substr(0, 40), "ends in the middle");
  expectUnread("a picture", "does not begin with");
}

TEST_F(Truths, NoiseIsWhatWasAskedFor) {
  ASSERT_EQ(runIrad(small("a.exr", {"--noise", "0.2"})).status, 0);
  const double reached = truth("a.json").at("relative_standard_error");
  const uint32_t samples = truth("a.json").at("samples_per_pixel");
  EXPECT_LE(reached, 0.2);
  EXPECT_GT(samples, 16u) << "too easy to say anything";
  // A pass less, and it is more.
  ASSERT_EQ(runIrad(small("b.exr", {"--spp", std::to_string(samples - 4)})).status, 0);
  EXPECT_GT(truth("b.json").at("relative_standard_error"), 0.2);
  // By hand, from the layers.
  const SavedSums saved = readSums(file("a.state"));
  const TracedPicture p = pictureOf(saved.sums);
  const double mean = (p.lit.pictureMean.x + p.lit.pictureMean.y + p.lit.pictureMean.z) / 3;
  double sum = 0;
  for (size_t i = 0; i < p.lit.mean.size(); ++i)
    for (int c = 0; c < 3; ++c)
      sum += std::pow(p.lit.error[i][c], 2) / (std::pow(p.lit.mean[i][c], 2) + std::pow(mean / 10, 2));
  EXPECT_NEAR(std::sqrt(sum / (3.0 * static_cast<double>(p.lit.mean.size()))), reached, 1e-9);
  // No time at all still gives a picture with a standard error.
  ASSERT_EQ(runIrad(small("c.exr", {"--seconds", "0"})).status, 0);
  EXPECT_GE(truth("c.json").at("samples_per_pixel"), 2);
}

TEST_F(Truths, CtrlCLeavesWholeFilesThatGoOn) {
  for (const int signal : {SIGINT, SIGTERM}) {
    Process process(
        iradProgram(),
        {"reference", "box", "--of", "triangles", "--size", "24x16", "--spp", "2000000", "--out", file("a.exr")},
        file("out"), file("err"));
    std::this_thread::sleep_for(std::chrono::milliseconds(1500));
    ASSERT_FALSE(process.poll()) << slurp(file("err"));
    ::kill(process.pid(), signal);
    EXPECT_EQ(process.wait(), 1) << slurp(file("err"));
    EXPECT_TRUE(contains(slurp(file("err")), "--resume goes on with them")) << slurp(file("err"));
    EXPECT_EQ(truth("a.json").at("complete"), false);
    EXPECT_EQ(readSums(file("a.state")).sums.samples, truth("a.json").at("samples_per_pixel"));
    EXPECT_EQ(readLinear(file("a.exr")).size, glm::uvec2(24, 16));
  }
  const uint32_t more = readSums(file("a.state")).sums.samples + 3;
  ASSERT_EQ(runIrad(small("a.exr", {"--resume", "--spp", std::to_string(more)})).status, 0);
  EXPECT_EQ(truth("a.json").at("complete"), true);
  ASSERT_EQ(runIrad(small("b.exr", {"--spp", std::to_string(more)})).status, 0);
  EXPECT_EQ(slurp(file("a.exr")), slurp(file("b.exr")));
}

#ifdef IRAD_OIIO
/// ../shared/scenes/references, of every material double-sided and Lambertian.
void expectCycles(const char* picture, const char* scenePath, const Camera* camera, uint32_t samples) {
  const auto scenes = sharedScenes();
  if (!scenes || !fs::exists(*scenes / scenePath) || !fs::exists(*scenes / "references" / picture))
    GTEST_SKIP() << "the folder of real scenes is absent: nothing to compare with";
  const ExrPicture cycles = readExr(*scenes / "references" / picture, "ViewLayer.Combined");
  Scene scene = loadScene(*scenes / scenePath, {.lambertian = true, .doubleSided = true});
  const Camera from = camera ? *camera : scene.cameras.at(0);
  const TracedPicture p =
      makePathTracer(std::move(scene))->render(from, {cycles.width, cycles.height}, {.samples = samples});
  const glm::dvec3 ratio = p.lit.pictureMean / cycles.mean(), error = p.lit.pictureError / cycles.mean();
  printf("%s: %.4f %.4f %.4f of Cycles, standard error %.4f; %.2f Mrays/s\n", picture, ratio.x, ratio.y, ratio.z,
         error.y, static_cast<double>(p.rays) / p.seconds * 1e-6);
  for (int c = 0; c < 3; ++c) {
    EXPECT_NEAR(ratio[c], 1, 0.01) << c;
    EXPECT_LT(error[c], 0.003) << "too noisy to say anything";
  }
}

TEST_F(Truths, CornellIsThatOfCycles) {
  const Camera camera{.position = {0, 1, 3.4}, .yfov = glm::radians(40.0f)};
  expectCycles("cornell_base_diffuse.exr", "variants/cornell_base.glb", &camera, 64);
}
TEST_F(Truths, SponzaIsThatOfCycles) {
  expectCycles("sponza_lit_diffuse.exr", "sponza/sponza_small_lit_m.glb", nullptr, 16);
}
#endif

// ---- All of them, by the program ----

class ThreeTruths : public Truths {
 protected:
  Words of(const char* what, const Words& more) const {
    return plus({"reference", "box", "--of", what, "--size", "24x16", "--set", "voxel.resolution=12", "--set",
                 "light.shadow_resolution=64", "--out", file(what) + std::string(linearExtension())},
                more);
  }
  /// Float or double triples of a .npy file.
  template <class T>
  std::vector<glm::vec<3, T>> npy(const std::string& name) const {
    const std::string bytes = slurp(folder_.path / name);
    const size_t header = 10 + static_cast<unsigned char>(bytes.at(8)) + 256u * static_cast<unsigned char>(bytes.at(9));
    std::vector<glm::vec<3, T>> values((bytes.size() - header) / sizeof(glm::vec<3, T>));
    std::memcpy(values.data(), bytes.data() + header, values.size() * sizeof(glm::vec<3, T>));
    return values;
  }
};

TEST_F(ThreeTruths, VoxelsAndMatrixAgreeWithinTheirNoise) {
  const RunResult voxels = runIrad(of("voxels", {"--facets", "--spp", "2000", "--set", "matrix.rays=64"}));
  ASSERT_EQ(voxels.status, 0) << voxels.err;
  const std::vector<glm::vec3> h = npy<float>("voxels.irradiance.npy"), e = npy<float>("voxels.standard_error.npy");
  ASSERT_EQ(h.size(), e.size());
  EXPECT_GE(truth("voxels.json").at("rays_per_facet"), 2000);
  // The mean of matrices by other seeds, whose spread says how far it is to be trusted.
  constexpr size_t kSeeds = 4;
  std::vector<std::vector<glm::dvec3>> exact;
  for (size_t s = 0; s < kSeeds; ++s) {
    const RunResult run = runIrad(of("matrix", {"--facets", "--seed", std::to_string(s + 10), "--set",
                                                "matrix.rays=256", "--set", "matrix.emitter_sampling=off"}));
    ASSERT_EQ(run.status, 0) << run.err;
    exact.push_back(npy<double>("matrix.irradiance.npy"));
    ASSERT_EQ(exact.back().size(), h.size());
  }
  size_t far = 0, of = 0;
  for (size_t i = 0; i < h.size(); ++i)
    for (int c = 0; c < 3; ++c) {
      double mean = 0, squares = 0;
      for (const auto& x : exact) {
        mean += x[i][c] / kSeeds;
        squares += x[i][c] * x[i][c] / kSeeds;
      }
      const double variance = std::max(squares - mean * mean, 0.0) / (kSeeds - 1) + double{e[i][c]} * e[i][c];
      ++of;
      far += std::abs(mean - h[i][c]) > 3 * std::sqrt(variance) + 1e-6 * mean;
    }
  printf("%zu of %zu values differ by more than 3 standard errors\n", far, of);
  // By Student's distribution with the 3 degrees of 4 seeds 5.8 %, had the frames no part in it.
  EXPECT_LT(static_cast<double>(far), 0.06 * static_cast<double>(of));
}

#ifdef IRAD_OIIO
TEST_F(ThreeTruths, TheErrorOfVoxelsBoundsWhatOtherSeedsGive) {
  std::array<ExrPicture, 2> picture, error;
  for (const size_t seed : {0u, 1u}) {
    const RunResult run = runIrad(of(
        "voxels", {"--layer", "indirect", "--spp", "600", "--set", "matrix.rays=32", "--seed", std::to_string(seed)}));
    ASSERT_EQ(run.status, 0) << run.err;
    picture[seed] = readExr(file("voxels.exr"));
    error[seed] = readExr(file("voxels.exr"), "error");
  }
  size_t far = 0, of = 0;
  double difference = 0, stated = 0;
  for (size_t i = 0; i < picture[0].pixels.size(); ++i)
    for (int c = 0; c < 3; ++c) {
      const double d = double{picture[0].pixels[i][c]} - picture[1].pixels[i][c],
                   e2 = std::pow(error[0].pixels[i][c], 2) + std::pow(error[1].pixels[i][c], 2);
      if (e2 == 0) continue;  // black
      ++of;
      far += std::abs(d) > 3 * std::sqrt(e2);
      difference += d * d;
      stated += e2;
    }
  printf("%zu of %zu differ by more than 3 standard errors; rms %.2f of what is stated\n", far, of,
         std::sqrt(difference / stated));
  EXPECT_GT(of, picture[0].pixels.size());
  EXPECT_LT(static_cast<double>(far), 0.01 * static_cast<double>(of));
  EXPECT_LT(difference, stated);  // neighbours' errors cancel in part
  EXPECT_GT(difference, 0.05 * stated) << "a bound that says nothing";
}
#endif

TEST_F(ThreeTruths, CtrlCKeepsTheFramesThatThereAre) {
  const Words words = of("voxels", {"--spp", "1000000", "--set", "matrix.rays=64"});
  Process process(iradProgram(), words, file("out"), file("err"));
  while (!process.poll() && !contains(slurp(file("err")), "frames of rays"))
    std::this_thread::sleep_for(std::chrono::milliseconds(50));
  std::this_thread::sleep_for(std::chrono::milliseconds(1000));
  ::kill(process.pid(), SIGINT);
  EXPECT_EQ(process.wait(), 1) << slurp(file("err"));
  EXPECT_TRUE(contains(slurp(file("err")), "interrupted: ")) << slurp(file("err"));
  EXPECT_EQ(truth("voxels.json").at("complete"), false);
  EXPECT_GE(truth("voxels.json").at("frames"), 2);
  EXPECT_EQ(readLinear(file("voxels") + std::string(linearExtension())).size, glm::uvec2(24, 16));
}

TEST_F(ThreeTruths, FramesGoOnToTheBitsOfOneRun) {
  const auto frames = [&](const char* out, const Words& more) {
    return runIrad(plus({"reference", "box", "--of", "voxels", "--size", "24x16", "--set", "voxel.resolution=12",
                         "--set", "matrix.rays=32", "--facets", "--out", file(out)},
                        more));
  };
  const std::string one = "one" + std::string(linearExtension()), two = "two" + std::string(linearExtension());
  ASSERT_EQ(frames(one.c_str(), {"--spp", "900"}).status, 0);
  ASSERT_EQ(frames(two.c_str(), {"--spp", "300"}).status, 0);
  EXPECT_NE(slurp(file(one.c_str())), slurp(file(two.c_str())));
  const std::string state = slurp(file("two.state"));
  // Of another light nothing goes on, and the state stays.
  const RunResult other = frames(two.c_str(), {"--spp", "900", "--resume", "--seed", "5"});
  EXPECT_EQ(other.status, 2);
  EXPECT_TRUE(contains(other.err, "matrix.seed \"0\", not \"5\"")) << other.err;
  EXPECT_EQ(slurp(file("two.state")), state);
  const RunResult rest = frames(two.c_str(), {"--spp", "900", "--resume"});
  ASSERT_EQ(rest.status, 0) << rest.err;
  EXPECT_TRUE(contains(rest.out, "of 51 frames of 32, 17 by earlier runs")) << rest.out;
  EXPECT_EQ(slurp(file(one.c_str())), slurp(file(two.c_str())));
  for (const char* end : {".irradiance.npy", ".standard_error.npy"})
    EXPECT_EQ(slurp(file(("one" + std::string(end)).c_str())), slurp(file(("two" + std::string(end)).c_str()))) << end;
  // Frames that are there are not traced again; what is drawn of them is the same.
  ASSERT_EQ(frames(two.c_str(), {"--spp", "900", "--resume"}).status, 0);
  EXPECT_EQ(slurp(file(one.c_str())), slurp(file(two.c_str())));
  // Damaged, and of another kind.
  std::string damaged = state;
  damaged[damaged.size() - 100] ^= 1;
  std::ofstream(file("two.state"), std::ios::binary) << damaged;
  const RunResult unread = frames(two.c_str(), {"--spp", "900", "--resume"});
  EXPECT_EQ(unread.status, 3);
  EXPECT_TRUE(contains(unread.err, "two.state: is damaged")) << unread.err;
  std::ofstream(file("a.state"), std::ios::binary) << state;
  const RunResult kind = runIrad(small("a.exr", {"--spp", "8", "--resume"}));
  EXPECT_TRUE(contains(kind.err, "a.state: does not begin with 'irad reference sums 1'")) << kind.err;
}

TEST_F(ThreeTruths, BouncesOfAFurnaceByTrianglesAndByTheMatrix) {
  // rho = .5, M = 1: what comes after k reflections is .5^(k + 1) / pi, and bounce.0 has M itself.
  for (const char* what : {"triangles", "matrix"}) {
    Words words{"reference", "check:furnace-box",
                "--of",      what,
                "--size",    "16x16",
                "--bounces", "3",
                "--set",     "scene.lambertian=true",
                "--out",     file(what) + std::string(linearExtension())};
    if (std::strcmp(what, "matrix") == 0)
      words = plus(words, {"--set", "voxel.resolution=12", "--set", "matrix.rays=64"});
    else
      words = plus(words, {"--spp", "400"});
    const RunResult run = runIrad(words);
    ASSERT_EQ(run.status, 0) << run.err;
    const nlohmann::json bounces = truth((what + std::string(".json")).c_str()).at("bounces");
    ASSERT_EQ(bounces.size(), 4u);
    for (size_t k = 0; k < 4; ++k) {
      const double known = (std::pow(0.5, static_cast<double>(k) + 1) + (k == 0 ? 1 : 0)) / std::numbers::pi,
                   mean = bounces[k].at("mean")[0], error = bounces[k].value("mean_error", std::vector<double>{0})[0];
      printf("%s: bounce %zu %.6f +- %.6f, expected %.6f\n", what, k, mean, error, known);
      EXPECT_NEAR(mean, known, 3 * error + 2e-4 * known) << what << k;  // albedos of facets have 16 bits
      EXPECT_LT(error, 0.01 * known);
    }
  }
}

TEST_F(ThreeTruths, OfAFurnaceAllGiveTheClosedForm) {
  const double expected = 2 / std::numbers::pi;  // rho = .5, M = 1: B = 2
  for (const char* what : {"triangles", "voxels", "matrix"}) {
    Words words{"reference", "check:furnace-box",
                "--of",      what,
                "--size",    "16x16",
                "--out",     file(what) + std::string(linearExtension())};
    const double samples = std::strcmp(what, "triangles") == 0 ? 256 : 2000;
    if (std::strcmp(what, "matrix") != 0) words = plus(words, {"--spp", std::to_string(int(samples))});
    if (std::strcmp(what, "triangles") != 0)
      words = plus(words, {"--set", "voxel.resolution=12", "--set", "matrix.rays=64", "--set", "specular.mode=off"});
    const RunResult run = runIrad(words);
    ASSERT_EQ(run.status, 0) << run.err;
    glm::dvec3 mean(0);
    const LinearPicture picture = readLinear(file(what) + std::string(linearExtension()));
    for (const glm::vec4& p : picture.pixels) mean += glm::dvec3(p) / static_cast<double>(picture.pixels.size());
    const double error = truth((what + std::string(".json")).c_str()).value("mean_error", std::vector<double>{0})[0];
    printf("%s: %.6f +- %.6f\n", what, mean.x, error);
    EXPECT_NEAR(mean.x, expected, 3 * error + 1e-4 * expected) << what;  // albedos of facets have 16 bits
  }
}

TEST_F(ThreeTruths, BadUsage) {
  struct Case {
    Words words;
    const char* expected;
  };
  for (const Case& c : {Case{{}, "--of: triangles, voxels or matrix"}, Case{{"--of", "voxel"}, "did you mean voxels"},
                        Case{{"--of", "triangles", "--layer", "direkt"}, "--layer: unknown 'direkt'"},
                        Case{{"--of", "triangles", "--spp", "1"}, "--spp: '1' is not allowed"},
                        Case{{"--of", "triangles", "--noise", "0"}, "--noise: '0' is not allowed"},
                        Case{{"--of", "triangles", "--seconds", "soon"}, "--seconds: 'soon' is not allowed"},
                        Case{{"--of", "matrix", "--spp", "8"}, "a matrix is solved to the end"},
                        Case{{"--of", "matrix", "--resume"}, "--resume is for --of triangles and voxels"},
                        Case{{"--of", "voxels", "--glossy"}, "--glossy is for --of triangles"},
                        Case{{"--of", "voxels", "--bounces", "2"}, "--bounces is for --of triangles and matrix"},
                        Case{{"--of", "triangles", "--glossy", "--glossy-seen"}, "--glossy or --glossy-seen, not both"},
                        Case{{"--of", "triangles", "--bounces", "32"}, "--bounces: '32' is not allowed"},
                        Case{{"--of", "triangles", "--layer", "specular"}, "--layer specular is for"},
                        Case{{"--of", "voxels", "--resume", "--set", "solver.lambda=1.01"}, "solver.lambda is above 1"},
                        Case{{"--of", "triangles", "--facets"}, "--facets is for --of voxels and matrix"},
                        Case{{"--of", "triangles", "--out", "ref.png"}, "--out: 'ref.png' does not end in"},
                        Case{{"--of", "triangles", "--camera", "all", "--camera", "all"}, "--camera: one, not"},
                        Case{{"--of", "voxels", "--set", "writeback.mode=compute"}, "writeback.mode is to be off"},
                        Case{{"--of", "matrix", "--set", "solver.method=brute_force"}, "has no matrix"}}) {
    const RunResult run = runIrad(plus({"reference", "box"}, c.words));
    EXPECT_EQ(run.status, 2) << c.expected << "\n" << run.err;
    EXPECT_TRUE(contains(run.err, c.expected)) << run.err;
  }
}

}  // namespace
}  // namespace irad::test::reference_truths_suite
