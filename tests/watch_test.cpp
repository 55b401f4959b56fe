// The numerical watch: wrong numbers put in at each stage are counted, traced to it and said; the energy balance; the
// divergence guard (docs/stability.md: divergence, energy).
#include <array>
#include <cmath>
#include <limits>

#include "gi/emitters.h"
#include "gi/facets.h"
#include "gi/gather_emitters.h"
#include "gi/grid.h"
#include "gi/lighting.h"
#include "gi/matrix.h"
#include "gi/pipeline.h"
#include "gi/solve.h"
#include "gi/subsystems.h"
#include "gi/watch.h"
#include "renderer/frame/record.h"
#include "shaders/shared/energy.h"
#include "tests/gi_fixture.h"
#include "tests/scene_files.h"

namespace irad::test::watch_suite {
namespace {

constexpr float kNan = std::numeric_limits<float>::quiet_NaN(), kInf = std::numeric_limits<float>::infinity();

Scene room() {
  SceneBuilder b = lampRoom();
  b.point({0.2, 0.3, 0.1}, 5);
  return b.finish("room");
}

class Watch : public GiTest {
 protected:
  template <class T>
  void put(const Buffer& buffer, uint32_t index, const T& value) {
    upload(context(), buffer, std::as_bytes(std::span(&value, 1)), index * sizeof(T));
  }
  std::vector<uint32_t> bits(const Buffer& buffer) { return downloadAs<uint32_t>(context(), buffer); }
};

TEST_F(Watch, AWrongNumberIsTracedToItsStageAndFacet) {
  Settings settings = at(16, 32);
  settings.matrix.emitterSampling = EffectMode::on;
  const World w = world(room(), settings);
  const FormFactors m = buildMatrix(context(), w.facets, w.field, settings);
  const Emitters emitters = listEmitters(context(), w.facets);
  const auto emission = downloadAs<glm::vec3>(context(), w.facets.emission);
  const auto rowInfo = downloadAs<glm::uvec2>(context(), m.rowInfo);
  const auto voxel = downloadAs<uint32_t>(context(), w.facets.voxel);
  const uint32_t bad = w.facets.count / 3;
  ASSERT_EQ(emission[bad], glm::vec3(0)) << "a lamp's facet: choose another";

  for (const SolverKernel kernel :
       {SolverKernel::tree, SolverKernel::subgroup, SolverKernel::row, SolverKernel::automatic})
    for (const auto& wrong : {std::pair{kNan, "NaN"}, {kInf, "infinite"}, {-1.0f, "negative"}}) {
      const float value = wrong.first;
      const char* word = wrong.second;
      settings.solver.kernel = kernel;
      Lighting light = makeLighting(context(), w.facets, settings);
      gatherEmitters(context(), w.facets, m, {&emitters, &w.field}, settings, light);
      const auto run = [&] { return solve(context(), w.facets, m, light, settings, 1000); };
      const SolveReport good = run();
      ASSERT_TRUE(good.converged);
      ASSERT_FALSE(good.defect);
      const std::vector<uint32_t> before = bits(light.radiosity);
      ASSERT_TRUE(light.correction);

      const auto expect = [&](const char* stage, const char* quantity) {
        const SolveReport report = run();
        SCOPED_TRACE(fmt::format("{} in {} of {}", word, quantity, stage));
        ASSERT_TRUE(report.defect);
        EXPECT_STREQ(report.defect->stage, stage);
        EXPECT_STREQ(report.defect->quantity, quantity);
        EXPECT_STREQ(report.defect->value, word);
        EXPECT_EQ(report.defect->facet, bad);
        EXPECT_EQ(report.defect->voxel, unpackVoxel(voxel[bad]));
        if (std::isnan(value)) {
          EXPECT_GT(report.nan, 0u);
        } else if (std::isinf(value)) {
          EXPECT_GT(report.nonFinite, 0u);
        } else {
          EXPECT_GT(report.negative, 0u);
          EXPECT_EQ(report.nonFinite, 0u);
        }
        EXPECT_TRUE(report.settled());
      };
      put(light.direct, bad, glm::vec4(0, value, 0, 0));
      put(light.direct, w.facets.count - 1, glm::vec4(value));  // the first is named
      expect("GI Gather", "direct irradiance");
      put(light.direct, bad, glm::vec4(0));
      put(light.direct, w.facets.count - 1, glm::vec4(0));

      put(w.facets.emission, bad, glm::vec3(0, 0, value));
      expect("GI CompactList", "emission");
      put(w.facets.emission, bad, emission[bad]);

      put(m.rowInfo, bad, glm::uvec2(rowInfo[bad].x, std::bit_cast<uint32_t>(value)));
      expect("GI BuildMatrix", "row sum of form factors");
      put(m.rowInfo, bad, rowInfo[bad]);

      if (value < 0) continue;  // a correction may be below zero; a negative B is replaced by the next sweep
      const auto emitted = downloadAs<glm::vec4>(context(), light.emitted),
                 correction = downloadAs<glm::vec4>(context(), light.correction);
      put(light.emitted, bad, glm::vec4(value));
      put(light.correction, bad, glm::vec4(value));
      expect("GI Solve Emitters", "irradiance from emitters");
      put(light.emitted, bad, emitted[bad]);
      put(light.correction, bad, correction[bad]);

      run();
      put(light.radiosity, bad, glm::vec4(value));
      const SolveReport spread = run();
      ASSERT_TRUE(spread.defect);
      EXPECT_STREQ(spread.defect->stage, "GI Solve");
      // A defect goes with its cause: the next solve starts from the dark, as the first did.
      const SolveReport again = run();
      EXPECT_TRUE(again.converged);
      EXPECT_FALSE(again.defect);
      EXPECT_EQ(bits(light.radiosity), before);
    }
}

TEST_F(Watch, PipelineSaysWhichStageFacetAndFrame) {
  Pipeline pipeline(context(), room(), at(16, 32));
  pipeline.prepare();
  EXPECT_TRUE(pipeline.findings().empty());
  const std::vector<uint32_t> before = bits(pipeline.lighting().indirect);
  const glm::vec3 candela = pipeline.device().lightValues.at(0).intensity;
  uint64_t frame = 0;
  for (const auto& [value, word] : {std::pair{kNan, "is NaN"}, {kInf, "is infinite"}, {-5.0f, "is negative"}}) {
    pipeline.device().lightValues[0].intensity = glm::vec3(value);
    pipeline.lightsChanged();
    pipeline.prepare();
    ++frame;
    const std::vector<Finding> said = pipeline.findings();
    ASSERT_EQ(said.size(), 1u) << word;
    EXPECT_EQ(said[0].severity, Finding::Severity::Error);
    EXPECT_TRUE(said[0].text.starts_with(
        fmt::format("numerical watch: GI Gather, frame {}: direct irradiance of facet ", frame)))
        << said[0].text;
    EXPECT_NE(said[0].text.find(word), std::string::npos) << said[0].text;
    EXPECT_TRUE(pipeline.asleep()) << "no sweep mends it";

    pipeline.device().lightValues[0].intensity = candela;
    pipeline.lightsChanged();
    pipeline.prepare();
    ++frame;
    EXPECT_TRUE(pipeline.findings().empty());
    if (value < 0) continue;  // a warm start from another light is equal only within the tolerance
    EXPECT_EQ(bits(pipeline.lighting().indirect), before);
  }
}

TEST(WatchedPicture, NamesCountsAndTheFirstPixel) {
  std::vector<glm::vec4> picture(12, glm::vec4(0.5f));
  EXPECT_EQ(findBadPixels(picture, {4, 3}, true), "");
  picture[6].y = -1;
  EXPECT_EQ(findBadPixels(picture, {4, 3}, false), "") << "a normal may be negative";
  EXPECT_EQ(findBadPixels(picture, {4, 3}, true), "0 NaN, 0 infinite, 1 negative of 12 pixels, the first at 2, 1");
  picture[5].z = kInf;
  picture[11] = {kNan, kInf, -1, 1};
  EXPECT_EQ(findBadPixels(picture, {4, 3}, true), "1 NaN, 1 infinite, 1 negative of 12 pixels, the first at 1, 1");
  picture[0].w = kNan;  // alpha, not a colour
  EXPECT_EQ(findBadPixels(picture, {4, 3}, false), "1 NaN, 1 infinite, 0 negative of 12 pixels, the first at 1, 1");
}

TEST(Energy, AreaOfAPlaneInACube) {
  const auto area = [](glm::vec3 n, float offset) { return facetArea(glm::normalize(n), offset); };
  EXPECT_FLOAT_EQ(area({0, 0, 1}, 0), 1);
  EXPECT_FLOAT_EQ(area({0, -1, 0}, 0.5f), 1);         // in the cell's very face
  EXPECT_FLOAT_EQ(area({1, 0, 0}, -64 / 127.0f), 1);  // and as far out as its code may put it
  EXPECT_FLOAT_EQ(area({1e-8f, 0, 1}, 0.5f), 1);      // with a normal as GPUs round it
  EXPECT_FLOAT_EQ(area({-6e-8f, -1, 3e-8f}, -64 / 127.0f), 1);
  EXPECT_FLOAT_EQ(area({1, 1, 1}, 0.87f), 0);
  EXPECT_NEAR(area({1, 1, 0}, 0), std::sqrt(2.0), 1e-5);
  EXPECT_NEAR(area({1, 0, -1}, 0.25f), std::sqrt(2.0) - 0.5, 1e-5);
  EXPECT_NEAR(area({-1, 1, 1}, 0), 0.75 * std::sqrt(3.0), 1e-5);  // the regular hexagon
  EXPECT_NEAR(area({0.001f, 0, 1}, 0.2f), 1, 1e-5);
  EXPECT_NEAR(area({0.001f, 0.0009f, 1}, 0), 1, 1e-3);
  // Any plane: the areas in 16^3 cells add up to that in the cube of them.
  for (const glm::vec3 direction : {glm::vec3(1, 2, 3), {0.05f, 1, 0.02f}, {3, -1, 3}, {0.4f, 0, -0.1f}}) {
    const glm::vec3 n = glm::normalize(direction);
    double sum = 0;
    const int cells = 16;
    for (int i = 0; i < cells * cells * cells; ++i) {
      const glm::vec3 centre = glm::vec3(i % cells, i / cells % cells, i / cells / cells) + 0.5f - 0.5f * cells;
      const float offset = 1.3f - glm::dot(n, centre);
      if (std::abs(offset) < 0.9f) sum += facetArea(n, offset);
    }
    const double whole = double{facetArea(n, 1.3f / cells)} * cells * cells;
    EXPECT_NEAR(sum, whole, 0.005 * whole) << direction.x;
  }
}

TEST_F(Watch, EnergyInIsEnergyOut) {
  Settings settings = at(32, 128);
  settings.solver.tolerance = 1e-5f;
  Pipeline pipeline(context(), room(), settings);
  pipeline.prepare();
  const Lighting& light = pipeline.lighting();
  const FacetList& facets = pipeline.facets();
  ASSERT_TRUE(light.report.energy);
  const EnergyBalance energy = *light.report.energy;
  // Against the sums in double.
  const auto areas = downloadAs<float>(context(), facets.area);
  const auto albedo = downloadAs<glm::uvec2>(context(), facets.albedo);
  const auto emission = downloadAs<glm::vec3>(context(), facets.emission);
  const auto direct = downloadAs<glm::vec4>(context(), light.direct),
             h = downloadAs<glm::vec4>(context(), light.indirect),
             b = downloadAs<glm::vec4>(context(), light.radiosity);
  const std::vector<HostRow> rows = hostRows(context(), pipeline.matrix());
  EnergyBalance expected;
  for (uint32_t i = 0; i < facets.count; ++i) {
    const double area = areas[i];
    const glm::dvec3 d(direct[i]), rho(unpackAlbedo(albedo[i]));
    expected.entering += area * (glm::dvec3(emission[i]) + d);
    expected.absorbed += area * (1.0 - rho) * (d + glm::dvec3(h[i]));
    expected.escaped += area * glm::dvec3(b[i]) * (1.0 - rows[i].sum());
  }
  for (int c = 0; c < 3; ++c) {
    EXPECT_NEAR(energy.entering[c], expected.entering[c], 1e-6 * expected.entering[c]);
    EXPECT_NEAR(energy.absorbed[c], expected.absorbed[c], 1e-6 * expected.absorbed[c]);
    EXPECT_NEAR(energy.escaped[c], expected.escaped[c], 1e-6 * expected.entering[c]);
  }
  fmt::print("room: {}\n", describe(energy, facets.grid.edge));
  EXPECT_LE(std::abs(energy.imbalance()), kImbalance);
  EXPECT_TRUE(pipeline.findings().empty());

  // The same bits again, whatever the order in which workgroups ran.
  const EnergyBalance again = balance(context(), facets, light);
  EXPECT_EQ(std::memcmp(&again, &energy, sizeof(energy)), 0);
  // Lost light is noticed: a quarter of H.
  auto less = h;
  for (glm::vec4& v : less) v *= 0.75f;
  upload(context(), light.indirect, std::as_bytes(std::span(less)));
  const EnergyBalance lost = balance(context(), facets, light);
  EXPECT_LT(lost.imbalance(), -kImbalance);
  SolveReport report = light.report;
  report.energy = lost;
  const std::vector<Finding> said = findings(report, facets.grid, glm::dvec3(0), 7);
  ASSERT_EQ(said.size(), 1u);
  EXPECT_EQ(said[0].severity, Finding::Severity::Warning);

  // With an artistic gain there is no balance to check.
  settings.solver.gpu.lambda = 0.8f;
  pipeline.set(settings);
  pipeline.prepare();
  EXPECT_TRUE(pipeline.lighting().report.converged);
  EXPECT_FALSE(pipeline.lighting().report.energy);
}

class Guard : public Watch {
 protected:
  static Settings gained(float lambda) {
    Settings settings = at(16, 32);
    settings.solver.gpu.lambda = lambda;
    return settings;
  }
};

TEST_F(Guard, DivergenceIsStoppedAndTheLightFromBeforeKept) {
  const Settings physical = gained(1);
  const World w = world(furnaceBox(0.9f), physical);
  const FormFactors m = buildMatrix(context(), w.facets, w.field, physical);
  // lambda 2 x .9 and 1.15 x .9: gains 1.8 and 1.035. At once, and 4 sweeps at a time as the window calls.
  for (const float lambda : {2.0f, 1.15f})
    for (const uint32_t atOnce : {1000u, 4u}) {
      SCOPED_TRACE(fmt::format("lambda {}, {} sweeps at a time", lambda, atOnce));
      Lighting light = makeLighting(context(), w.facets, physical);
      const uint64_t held = context().device.memory().used();
      ASSERT_TRUE(solve(context(), w.facets, m, light, physical, 1000).converged);
      const auto radiosity = bits(light.radiosity), indirect = bits(light.indirect);
      uint32_t sweeps = 0;
      do {
        const SolveReport report = solve(context(), w.facets, m, light, gained(lambda), atOnce);
        sweeps += report.sweeps;
        ASSERT_LE(sweeps, 20u);
      } while (!light.report.settled());
      fmt::print("lambda {}: stopped after {} sweeps, growth {:.3f} at omega {}\n", lambda, sweeps, light.report.growth,
                 light.report.omega);
      EXPECT_TRUE(light.report.diverging);
      EXPECT_FALSE(light.report.converged);
      EXPECT_EQ(light.report.nonFinite + light.report.negative, 0u);
      EXPECT_NEAR(light.report.growth, 1 + light.report.omega * (0.9 * lambda - 1), 1e-3);
      EXPECT_EQ(bits(light.radiosity), radiosity);
      EXPECT_EQ(bits(light.indirect), indirect);
      const std::vector<Finding> said = findings(light.report, w.facets.grid, glm::dvec3(0), 3);
      ASSERT_EQ(said.size(), 1u);
      EXPECT_EQ(said[0].severity, Finding::Severity::Error);
      EXPECT_TRUE(said[0].text.starts_with("numerical watch: GI Solve, frame 3: diverging")) << said[0].text;
      // Back to physics, without a trace: B was at rest, and the copies from before are gone.
      const SolveReport back = solve(context(), w.facets, m, light, physical, 1000);
      EXPECT_TRUE(back.converged);
      EXPECT_LE(back.sweeps, 2u);
      context().finish();
      EXPECT_EQ(context().device.memory().used(), held);
    }
}

TEST_F(Guard, EdgesAreRemovedFromTheLightThatWasPutBack) {
  Settings settings = gained(0.8f);
  settings.matrix.gpu.hitRule = HitRule::thesis;
  settings.scatter.edgeRemoval = true;
  Pipeline pipeline(context(), furnaceBox(0.9f), settings);
  pipeline.prepare();
  const std::vector<std::byte> before = download(context(), pipeline.lighting().volume.image);
  settings.solver.gpu.lambda = 2;
  pipeline.set(settings);
  pipeline.prepare();
  ASSERT_TRUE(pipeline.lighting().report.diverging);
  EXPECT_EQ(download(context(), pipeline.lighting().volume.image), before);
}

TEST_F(Guard, GrowthThatEndsIsDampedAndConverges) {
  // A chain: facet i sees facet i - 1 alone, with gain 1.5. Nothing returns, so that the spectral radius is 0; but the
  // first facet's light grows along the chain, sweep after sweep.
  constexpr uint32_t kFacets = 12;
  const Settings settings = gained(1.875f);
  std::vector<uint32_t> voxel, shape, entries, starts;
  std::vector<glm::uvec2> info;
  for (uint32_t i = 0; i < kFacets; ++i) {
    voxel.push_back(packVoxel({i + 1, 1, 1}));
    shape.push_back(encodeNormal(glm::vec3(0, 1, 0), NORMALS_OCT16) | packFacetOffset(0));
    starts.push_back(static_cast<uint32_t>(entries.size()));
    info.emplace_back(i > 0 ? 1u : 0u, std::bit_cast<uint32_t>(1.0f));
    if (i > 0) entries.push_back((i - 1) | 1u << 8);
  }
  const FacetList facets =
      uploadFacets(context(), makeGrid(glm::vec3(0), glm::vec3(1), 16), voxel, shape,
                   std::vector<glm::uvec2>(kFacets, packAlbedo(glm::vec3(0.8f))), {}, NormalEncoding::oct16);
  FormFactors m;
  m.rows = kFacets;
  m.rays = 1;
  m.segments.push_back(makeBuffer(context(), "chain", Subsystem::Matrix, std::span<const uint32_t>(entries)));
  m.rowStart = makeBuffer(context(), "starts", Subsystem::Matrix, std::span<const uint32_t>(starts));
  m.rowInfo = makeBuffer(context(), "info", Subsystem::Matrix, std::span<const glm::uvec2>(info));
  RecordMaker table(context(), "segments", Subsystem::Matrix, sizeof(uint64_t));
  const Buffer segments = table.make(table.of(m.segments[0]));
  RecordMaker record(context(), "record", Subsystem::Matrix, sizeof(MatrixArrays));
  m.record =
      record.make(MatrixArrays{record.of(segments), record.of(m.rowStart), record.of(m.rowInfo), kFacets, 31, 8, 0});

  Lighting light = makeLighting(context(), facets, settings);
  put(light.direct, 0, glm::vec4(1, 0, 0, 0));
  const SolveReport report = solve(context(), facets, m, light, settings, 1000);
  fmt::print("chain: {} sweeps, omega {}\n", report.sweeps, report.omega);
  EXPECT_TRUE(report.converged);
  EXPECT_TRUE(report.damped);
  EXPECT_FALSE(report.diverging);
  EXPECT_EQ(report.omega, 0.5f);
  const auto b = downloadAs<glm::vec4>(context(), light.radiosity);
  for (uint32_t i = 0; i < kFacets; ++i) EXPECT_NEAR(b[i].x, std::pow(1.5, i + 1), 1e-4 * b[i].x) << i;
  const std::vector<Finding> said = findings(report, facets.grid, glm::dvec3(0), 0);
  ASSERT_EQ(said.size(), 1u);
  EXPECT_EQ(said[0].severity, Finding::Severity::Warning);
}

// ---- The commands: exit status 1, and the reason
// ---------------------------------------------------------------------

TEST(WatchedCommands, DivergenceEndsWithStatusOne) {
  const TemporaryFolder folder;
  const std::vector<std::string> quick{"--set", "voxel.resolution=24", "--set", "matrix.rays=32",
                                       "--set", "solver.lambda=2",     "--set", "light.shadow_resolution=64"};
  const auto run = [&](std::vector<std::string> arguments) {
    arguments.insert(arguments.end(), quick.begin(), quick.end());
    return runIrad(arguments);
  };
  const std::string out = folder.path / "out";
  RunResult r = run({"render", "box", "--size", "32x32", "--out", out});
  EXPECT_EQ(r.status, 1);
  EXPECT_NE(r.err.find("error: numerical watch: GI Solve, frame 0: diverging"), std::string::npos) << r.err;
  EXPECT_TRUE(std::filesystem::exists(folder.path / "out/lit.png")) << "the pictures show what there is";
  r = run({"bench", "box", "--size", "32x32", "--frames", "1", "--rebuilds", "1"});
  EXPECT_EQ(r.status, 1);
  EXPECT_NE(r.err.find("numerical watch: GI Solve"), std::string::npos) << r.err;
  r = run({"export", "box", "--facets", "--out", folder.path / "arrays"});
  EXPECT_EQ(r.status, 1);
  EXPECT_NE(r.err.find("numerical watch: GI Solve"), std::string::npos) << r.err;
  EXPECT_FALSE(std::filesystem::exists(folder.path / "arrays")) << "nothing was written, and no folder is left";
}

TEST(WatchedCommands, InfiniteLightIsNamedAndPictured) {
  const TemporaryFolder folder;
  // The brightest lamp that a file may hold, candela, half a nanometre before the triangle: beyond fp32.
  GltfFile file;
  file.attributes()["POSITION"] = file.vec3({0, 0, 0, 1e-9f, 0, 0, 0, 1e-9f, 0});
  file.json["extensionsUsed"] = {"KHR_lights_punctual"};
  file.json["extensions"]["KHR_lights_punctual"]["lights"] = {
      {{"type", "point"}, {"color", {1e12, 1e12, 1e12}}, {"intensity", 1e12}}};
  file.json["nodes"].push_back(
      {{"translation", {2.5e-10, 2.5e-10, 5e-10}}, {"extensions", {{"KHR_lights_punctual", {{"light", 0}}}}}});
  file.json["scenes"][0]["nodes"] = {0, 1};
  const std::string scene = file.write(folder.path);
  const std::vector<std::string> quick{
      "--set",
      "voxel.resolution=16",
      "--set",
      "matrix.rays=16",
      "--size",
      "24x24",
      "--camera",
      R"({"position": [2.5e-10, 2.5e-10, 2e-9], "target": [2.5e-10, 2.5e-10, 0], "znear": 1e-10, "zfar": 1e-8})"};
  std::vector<std::string> arguments{"render", scene, "--out", folder.path / "out"};
  arguments.insert(arguments.end(), quick.begin(), quick.end());
  const RunResult r = runIrad(arguments);
  EXPECT_EQ(r.status, 1) << r.err;
  EXPECT_NE(r.err.find("numerical watch: GI Gather, frame 0: direct irradiance of facet "), std::string::npos) << r.err;
  EXPECT_NE(r.err.find("is infinite"), std::string::npos) << r.err;
  EXPECT_NE(r.err.find("numerical watch: picture lit: "), std::string::npos) << r.err;
  for (const char* name : {"lit.png", "lit.exr", "manifest.json"})
    EXPECT_TRUE(std::filesystem::exists(folder.path / "out" / name)) << name;
}

TEST_F(Watch, FromTheDarkTheSameLightComesBack) {
  Pipeline pipeline(context(), room(), at(16, 32));
  pipeline.prepare();
  const std::vector<uint32_t> solved = bits(pipeline.lighting().indirect);
  pipeline.darken();
  EXPECT_FALSE(pipeline.asleep());
  for (const uint32_t word : bits(pipeline.lighting().indirect)) ASSERT_EQ(word, 0u);
  pipeline.prepare();
  EXPECT_TRUE(pipeline.asleep());
  EXPECT_EQ(bits(pipeline.lighting().indirect), solved);
}

}  // namespace
}  // namespace irad::test::watch_suite
