// What a rebuild is predicted to take, against real builds of the Box at several resolutions and numbers of rays.
#include <algorithm>
#include <chrono>
#include <cmath>
#include <ctime>
#include <set>

#include "gi/build_cost.h"
#include "gi/pipeline.h"
#include "renderer/frame/pipeline_wait.h"
#include "renderer/scene/scene.h"
#include "tests/gi_fixture.h"

namespace irad::test::build_cost_suite {
namespace {

Settings sized(uint32_t resolution, uint32_t rays) {
  Settings settings = defaultSettings(/*cpuDevice=*/true);
  settings.voxel.resolution = resolution;
  settings.matrix.gpu.rays = rays;
  return settings;
}

TEST(BuildTimes, GrowAsTheDocumentsSay) {
  BuildTimes times;
  const Settings made = sized(64, 128);
  EXPECT_FALSE(times.predict(made, Redo::Voxels)) << "nothing was timed";
  times.took(BuildTimes::Part::Voxels, 400, made);
  times.took(BuildTimes::Part::Field, 2, made);
  times.took(BuildTimes::Part::Matrix, 2000, made);
  times.took(BuildTimes::Part::Gather, 60, made);
  times.took(BuildTimes::Part::Solve, 30, made);
  times.took(BuildTimes::Part::Scatter, 10, made);
  EXPECT_FALSE(times.predict(made, Redo::Nothing));
  EXPECT_FALSE(times.predict(made, Redo::Shade));
  EXPECT_NEAR(*times.predict(made, Redo::Voxels), 2502, 1e-6) << "the same again";
  EXPECT_NEAR(*times.predict(made, Redo::Matrix), 2100, 1e-6);
  EXPECT_NEAR(*times.predict(made, Redo::Gather), 100, 1e-6);
  EXPECT_NEAR(*times.predict(made, Redo::Solve), 40, 1e-6) << "light that is only solved anew is not gathered";
  EXPECT_NEAR(*times.predict(made, Redo::Scatter), 10, 1e-6) << "another filter of the lookup is no relight";
  EXPECT_FALSE(times.predict(made, Redo::Materials)) << "facets were never shaded anew";
  times.took(BuildTimes::Part::Materials, 5, made);
  EXPECT_NEAR(*times.predict(made, Redo::Materials), 105, 1e-6);
  EXPECT_NEAR(*times.predict(made, Redo::Matrix), 2100, 1e-6) << "a build shades its facets as it makes them";
  // docs/performance.md: 128 rays from N = 64 to 192, and N = 128 from 64 to 384 rays.
  BuildTimes documented;
  documented.took(BuildTimes::Part::Matrix, 2269, made);
  for (const auto light : {BuildTimes::Part::Gather, BuildTimes::Part::Solve, BuildTimes::Part::Scatter})
    documented.took(light, 0, made);
  EXPECT_NEAR(*documented.predict(sized(192, 128), Redo::Matrix), 18870, 0.02 * 18870);
  documented.took(BuildTimes::Part::Matrix, 4106, sized(128, 64));
  EXPECT_NEAR(*documented.predict(sized(128, 384), Redo::Matrix), 21871, 0.02 * 21871);
}

/// Shaders that are compiled for a part are compiled once: what the part takes again is the rest.
TEST(BuildTimes, LeaveOutWhatCompilesShaders) {
  const Settings made = sized(64, 128);
  BuildWatch watch;
  watch.runs(BuildTimes::Part::Gather, 1000, 500);
  watch.runs(BuildTimes::Part::Gather, 1700, 900);  // 400 of these for shaders
  watch.runs(BuildTimes::Part::Solve, 2000, 1100);  // and 200
  watch.runs(BuildTimes::Part::Scatter, 2050, 1100);
  watch.runs({}, 2080, 1120);
  BuildTimes times;
  watch.tell(times, made);
  EXPECT_NEAR(*times.predict(made, Redo::Scatter), 10, 1e-6);
  EXPECT_NEAR(*times.predict(made, Redo::Solve), 60, 1e-6);
  EXPECT_NEAR(*times.predict(made, Redo::Gather), 460, 1e-6);
  EXPECT_FALSE(times.predict(made, Redo::Matrix)) << "a part that has not run";
}

TEST(BuildTimes, StagesHaveTheNamesOfTheirProgress) {
  EXPECT_EQ(BuildTimes::partOf("GI Voxelization"), BuildTimes::Part::Voxels);
  EXPECT_EQ(BuildTimes::partOf("GI SDF"), BuildTimes::Part::Field);
  EXPECT_EQ(BuildTimes::partOf("GI BuildMatrix"), BuildTimes::Part::Matrix);
  EXPECT_EQ(BuildTimes::partOf("GI Materials"), BuildTimes::Part::Materials);
  EXPECT_EQ(BuildTimes::partOf("GI Gather"), BuildTimes::Part::Gather);
  for (const char* light : {"GI Solve", "GI BruteForce"})
    EXPECT_EQ(BuildTimes::partOf(light), BuildTimes::Part::Solve) << light;
  EXPECT_EQ(BuildTimes::partOf("GI Scatter"), BuildTimes::Part::Scatter);
  EXPECT_EQ(costText({1900, 480u << 20}), "1.9 s, 480 MiB");
  EXPECT_EQ(costText({420, 12u << 20}), "420 ms, 12 MiB");
}

class BuildCostTest : public GiTest {};

/// What is told of an edit is what is timed of it: a stage that does not run must not be taken for a quick one.
TEST_F(BuildCostTest, AnEditTellsTheStagesThatItRedoes) {
  Pipeline pipeline(context(), loadScene(assets() / "box.glb"), sized(16, 16));
  const auto redone = [&] {
    std::set<std::string> stages;
    pipeline.prepare([&](const char* stage, float) { return stages.insert(stage), true; });
    return stages;
  };
  // A build waits for its shaders; the same build again does not.
  redone();
  const double waited = pipelineWaitMs(context());
  EXPECT_GT(waited, 0);
  pipeline.invalidate(Redo::Voxels);
  EXPECT_TRUE(redone().contains("GI Voxelization"));
  EXPECT_EQ(pipelineWaitMs(context()), waited);
  Settings edited = pipeline.settings();
  const auto edit = [&](const char* name, double value) {
    for (const Setting& setting : settingTable())
      if (std::string_view(name) == setting.name) setting.set(edited, value);
    pipeline.set(edited);
    return redone();
  };
  EXPECT_EQ(edit("sample.filter", static_cast<double>(SampleFilter::linear)), std::set<std::string>{"GI Scatter"});
  EXPECT_EQ(edit("solver.tolerance", 1e-4), (std::set<std::string>{"GI Solve", "GI Scatter"}));
  EXPECT_EQ(edit("light.points", 8), (std::set<std::string>{"GI Gather", "GI Solve", "GI Scatter"}));
  EXPECT_EQ(edit("matrix.rays", 20), (std::set<std::string>{"GI BuildMatrix", "GI Gather", "GI Solve", "GI Scatter"}));
}

/// From each of several sizes to others. The memory's formulas are exact but for the counts of facets and entries that
/// they are given. Times are the machine's, and waver by more than the growth is off: they are printed, and what is
/// held is the growth itself, above.
TEST_F(BuildCostTest, IsNearToWhatRealBuildsTake) {
  const std::vector<std::pair<uint32_t, uint32_t>> sizes{{32, 64}, {48, 64}, {64, 64}, {64, 128}, {48, 128}};
  Pipeline pipeline(context(), loadScene(assets() / "box.glb"), sized(32, 64));
  BuildTimes times;
  const auto build = [&] {
    // On a processor its time, which other programs do not lengthen.
    const auto time = [&] {
      const auto wall = std::chrono::steady_clock::now().time_since_epoch();
      return context().device.isCpu ? 1e3 * static_cast<double>(std::clock()) / CLOCKS_PER_SEC
                                    : std::chrono::duration<double, std::milli>(wall).count();
    };
    const double began = time();
    BuildWatch watch;
    const auto runs = [&](std::optional<BuildTimes::Part> next) { watch.runs(next, time(), 0); };
    pipeline.prepare([&](const char* stage, float) { return runs(BuildTimes::partOf(stage)), true; }, 4);
    runs({});
    watch.tell(times, pipeline.settings());
    return BuildCost{time() - began, context().device.memory().used()};
  };
  for (const auto& [resolution, rays] : sizes) {  // compiles the shaders
    pipeline.set(sized(resolution, rays));
    build();
  }
  double worstMemory = 0, worstTime = 0;
  for (const auto& [resolution, rays] : sizes) {
    const Settings wanted = sized(resolution, rays);
    const Redo first = pipeline.due(wanted);
    ASSERT_LT(first, Redo::Shade);
    const std::optional<double> ms = times.predict(wanted, first);
    ASSERT_TRUE(ms);
    const uint64_t bytes = predictedBytes(pipeline, context().device.memory().used(), wanted, first);
    pipeline.set(wanted);
    const BuildCost took = build();
    fmt::print("N {} rays {}: predicted {}; took {}\n", resolution, rays, costText({*ms, bytes}), costText(took));
    const double memory = static_cast<double>(bytes) / static_cast<double>(took.bytes);
    worstMemory = std::max(worstMemory, std::abs(std::log(memory)));
    worstTime = std::max(worstTime, std::abs(std::log(*ms / took.ms)));
  }
  fmt::print("off by at most a factor {:.2f} in time, {:.3f} in memory\n", std::exp(worstTime), std::exp(worstMemory));
  EXPECT_LT(std::exp(worstMemory), 1.15);
}

}  // namespace
}  // namespace irad::test::build_cost_suite
