// Studies without a device: grids of settings, fronts, rows on disk, merging, the report.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <fstream>
#include <functional>
#include <limits>
#include <numeric>
#include <random>

#include "app/study_ahead.h"
#include "app/study_run.h"
#include "gi/study/front.h"
#include "gi/study/html.h"
#include "gi/study/layers.h"
#include "gi/study/loaded.h"
#include "gi/study/pick.h"
#include "gi/study/plot.h"
#include "gi/study/report.h"
#include "gi/study/report_parts.h"
#include "gi/study/results.h"
#include "gi/study/slope.h"
#include "gi/study/sweep.h"
#include "gi/study/tune.h"
#include "renderer/base/error.h"
#include "renderer/base/image_io.h"
#include "renderer/base/output_file.h"
#include "renderer/scene/camera_json.h"
#include "tests/support.h"

namespace irad::test::study_suite {
namespace {

namespace fs = std::filesystem;

std::string refusal(const std::vector<std::string>& sweeps) {
  try {
    const SettingGrid grid(sweeps, Settings{});
  } catch (const UsageError& error) {
    return error.what();
  }
  return "";
}

TEST(Sweeps, AreListsAndRanges) {
  const std::vector<std::string> sweeps{"voxel.resolution=32,64", "matrix.rays=64..1024*2", "solver.omega=0.5..1+0.25"};
  const SettingGrid grid(sweeps, Settings{});
  EXPECT_EQ(grid.texts(),
            (std::vector<std::vector<std::string>>{
                {"voxel.resolution=32,64", "matrix.rays=64,128,256,512,1024", "solver.omega=0.5,0.75,1"}}));
  EXPECT_EQ(grid.size(), 30u);
  EXPECT_EQ(grid.values(0), (std::vector<std::string>{"32", "64", "0.5"}));
  EXPECT_EQ(grid.values(1), (std::vector<std::string>{"32", "64", "0.75"})) << "the last changes first";
  EXPECT_EQ(grid.values(29), (std::vector<std::string>{"64", "1024", "1"}));
  EXPECT_EQ(grid.settings(29).matrix.gpu.rays, 1024u);
  EXPECT_EQ(grid.label(4), "voxel.resolution=32 matrix.rays=128 solver.omega=0.75");
  EXPECT_EQ(SettingGrid(std::vector<std::string>{}, Settings{}).size(), 1u) << "the settings as they are";
  const std::vector<std::string> choice{"matrix.traversal=dda,sdf", "matrix.jitter=true,off"};
  EXPECT_EQ(SettingGrid(choice, Settings{}).values(3), (std::vector<std::string>{"sdf", "false"}));
}

TEST(Sweeps, OfSeveralGridsKeepTheNumbersOfTheirPoints) {
  Settings base;
  base.matrix.gpu.rays = 64;
  const std::vector<std::string> coarse{"voxel.resolution=32,64"}, fine{"matrix.rays=64,128", "voxel.resolution=64,96"};
  SettingGrid grid(coarse, base);
  grid.add(fine);
  ASSERT_EQ(grid.size(), 5u) << "(64, 64) is in both";
  EXPECT_EQ(grid.label(1), "voxel.resolution=64 matrix.rays=64") << "what the first did not sweep is as given";
  EXPECT_EQ(grid.label(2), "voxel.resolution=96 matrix.rays=64");
  EXPECT_EQ(grid.label(4), "voxel.resolution=96 matrix.rays=128");
  EXPECT_EQ(grid.settings(3).voxel.resolution, 64u);
  EXPECT_EQ(grid.find(grid.settings(3)), 3u);
  Settings other = grid.settings(3);
  other.voxel.resolution = 65;
  EXPECT_EQ(grid.find(other), std::nullopt);
  EXPECT_EQ(SettingGrid(grid.texts(), base).labels(), grid.labels());
  const std::vector<std::string> before = grid.labels(), wrong{"solver.omega=0.5", "matrix.format=padded"};
  EXPECT_THROW(grid.add(wrong), UsageError);
  EXPECT_EQ(grid.labels(), before) << "as it was";
}

TEST(Sweeps, RefuseWhatIsWrongByNameAndValue) {
  EXPECT_TRUE(contains(refusal({"voxel.resolutoin=3"}), "did you mean voxel.resolution"));
  EXPECT_TRUE(contains(refusal({"voxel.resolution"}), "expected NAME=VALUE"));
  EXPECT_TRUE(contains(refusal({"voxel.resolution=64,4"}), "voxel.resolution: '4' is not allowed"));
  EXPECT_TRUE(contains(refusal({"voxel.resolution=64..4096*4"}), "voxel.resolution: '1024' is not allowed"));
  EXPECT_TRUE(contains(refusal({"matrix.rays=64,32,64"}), "matrix.rays: 64 is there twice"));
  EXPECT_TRUE(contains(refusal({"matrix.rays=64..1024"}), "'64..1024' has no step"));
  EXPECT_TRUE(contains(refusal({"matrix.rays=64..1024*1"}), "'64..1024*1' does not get from 64 to 1024"));
  EXPECT_TRUE(contains(refusal({"matrix.rays=64..32+8"}), "does not get"));
  EXPECT_TRUE(contains(refusal({"matrix.rays=64..x*2"}), "'x' of '64..x*2' is no number"));
  EXPECT_TRUE(contains(refusal({"matrix.rays=1..1e9+1"}), "values"));
  EXPECT_TRUE(contains(refusal({"matrix.traversal=dda..sdf*2"}), "is a range, but its values are"));
  EXPECT_TRUE(contains(refusal({"matrix.rays=32", "matrix.rays=64"}), "matrix.rays: is swept twice"));
  EXPECT_TRUE(contains(refusal({"matrix.seed=1,2"}), "--seeds"));
  EXPECT_TRUE(contains(refusal({"matrix.rays=1..4000+1", "voxel.resolution=8..100+1"}), "more than 10000"));
  EXPECT_TRUE(contains(refusal({"matrix.format=csr,padded"}), "the point matrix.format=padded: matrix.format=padded"));
}

TEST(Sweeps, ShardsShareThePoints) {
  const Shard second = parseShard("2/3");
  EXPECT_FALSE(second.has(0));
  EXPECT_TRUE(second.has(1));
  EXPECT_TRUE(second.has(4));
  for (const char* wrong : {"0/3", "4/3", "2", "a/b", "1/0", "1/3x", "-1/3"})
    EXPECT_THROW(parseShard(wrong), UsageError);
  try {
    parseShard("4/3");
  } catch (const UsageError& error) {
    EXPECT_STREQ(error.what(), "--shard: '4/3': the part is not 1 to 3");
  }
}

bool better(const CostAndError& a, const CostAndError& b) {
  return a.cost <= b.cost && a.error <= b.error && (a.cost < b.cost || a.error < b.error);
}

TEST(Fronts, AreWhatComparingAllPairsGives) {
  std::mt19937 random(7);
  for (int trial = 0; trial < 300; ++trial) {
    const size_t count = 1 + random() % 40;
    const uint32_t values = 2 + random() % 30;  // few: many are equal
    std::vector<CostAndError> points;
    for (size_t i = 0; i < count; ++i)
      points.push_back({static_cast<double>(random() % values), static_cast<double>(random() % values)});
    const std::vector<std::optional<size_t>> by = dominators(points);
    const std::vector<size_t> best = front(points);
    for (size_t i = 0; i < count; ++i) {
      const bool beaten = std::ranges::any_of(points, [&](const CostAndError& p) { return better(p, points[i]); });
      EXPECT_EQ(by[i].has_value(), beaten);
      EXPECT_EQ(std::ranges::find(best, i) == best.end(), beaten);
      if (!by[i]) continue;
      EXPECT_TRUE(better(points[*by[i]], points[i]));
      EXPECT_FALSE(by[*by[i]]) << "named by a point that is on the front";
      for (const CostAndError& p : points) {
        EXPECT_TRUE(!better(p, points[i]) || p.error >= points[*by[i]].error) << "the least error of those";
      }
    }
    for (size_t i = 0; i + 1 < best.size(); ++i) EXPECT_LE(points[best[i]].cost, points[best[i + 1]].cost);
  }
}

TEST(Fronts, LeaveOutWhatIsNoNumber) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const std::vector<CostAndError> points{{nan, 0}, {1, 3}, {2, nan}, {2, 1}};
  EXPECT_EQ(front(points), (std::vector<size_t>{1, 3}));
  EXPECT_EQ(dominators(points)[0], 3u);
  EXPECT_TRUE(front(std::vector<CostAndError>{{nan, nan}}).empty());
}

/// Three resolutions: an error that falls, times that rise, and a last point that is worse and dearer than the second.
StudyResults someResults() {
  StudyResults r;
  const double errors[] = {.1 / 3, .01, .02}, build[] = {10, 40, 80};
  for (size_t point = 0; point < 3; ++point) {
    for (uint32_t seed = 0; seed < 3; ++seed)
      r.errors.push_back({point, seed, errors[point] * (1 + .01 * seed), .1, -.001, 30, .05, 1000, 20000, 1.5,
                          10 + 5 * static_cast<double>(point)});
    for (uint32_t repeat = 0; repeat < 5; ++repeat) {
      const double ms = build[point] + repeat;
      r.times.push_back({point, repeat, "setup", "GI Voxelize", .25 * ms});
      r.times.push_back({point, repeat, "setup", "GI, Build \"Matrix\"", .75 * ms});
      r.times.push_back({point, repeat, "setup", "wall", 2 * ms});
      r.times.push_back({point, repeat, "cold", "GI Solve", 3});
      r.times.push_back({point, repeat, "relight", "GI Solve", 2});
      r.times.push_back({point, repeat, "camera", "Forward", 1});
    }
  }
  r.peers.push_back({"path-tracer", 2, .1, .5, .2, 0, 20, .3});
  r.peers.push_back({"path-tracer", 8, .4, .125, .1, 0, 25, .2});
  r.peers.push_back({"path-tracer", 200, 10, .005, .02, 0, 40, .05});
  return r;
}
const std::vector<std::string> kSweep{"voxel.resolution=16,32,64"};

TEST(Results, ComeBackFromTheirFilesAsTheyWere) {
  TemporaryFolder folder;
  const StudyIdentity identity = R"({"scene": "box", "sweeps": [["a"]], "settings": {"matrix.rays": 16}})";
  StudyFolder written(folder.path / "s", identity);
  written.results = someResults();
  written.results.failures.push_back({1, "no memory:\n\"much\", it needs"});
  written.save();
  const auto files = contents(folder.path / "s");
  StudyFolder read(folder.path / "s", identity);
  ASSERT_EQ(read.results.errors.size(), 9u);
  EXPECT_EQ(read.results.errors[1].relMse, written.results.errors[1].relMse) << "to the last bit";
  EXPECT_EQ(read.results.times.size(), written.results.times.size());
  EXPECT_EQ(read.results.failures.at(0).message, "no memory: \"much\", it needs");
  EXPECT_TRUE(read.results.hasTimes(2, 4));
  EXPECT_FALSE(read.results.hasTimes(2, 5));
  read.save();
  EXPECT_EQ(contents(folder.path / "s"), files);

  try {
    StudyFolder other(folder.path / "s", R"({"scene": "park", "sweeps": [["a"]], "settings": {"matrix.rays": 32}})");
    FAIL() << "another study's results are not gone on with";
  } catch (const UsageError& error) {
    EXPECT_TRUE(contains(error.what(), "scene \"box\" instead of \"park\", matrix.rays 16 instead of 32"))
        << error.what();
  }
  std::ofstream(folder.path / "s" / "errors.csv") << "point,seed\n1,2\n";
  EXPECT_THROW(readResults(folder.path / "s"), InputError);
  std::string text = files.at("times.csv");
  text.replace(text.find("0,0,setup"), 1, "x");
  std::ofstream(folder.path / "s" / "errors.csv") << files.at("errors.csv");
  std::ofstream(folder.path / "s" / "times.csv") << text;
  try {
    readResults(folder.path / "s");
    FAIL();
  } catch (const InputError& error) {
    EXPECT_TRUE(contains(error.what(), "times.csv: row 1: 'x' is no number")) << error.what();
  }
}

TEST(Results, AStudyGetsFurtherGrids) {
  TemporaryFolder folder;
  const auto identity = [](const char* sweeps) { return fmt::format(R"({{"scene": "box", "sweeps": {}}})", sweeps); };
  const auto open = [&](const char* sweeps) { return StudyFolder(folder.path / "s", identity(sweeps)).identity(); };
  StudyFolder(folder.path / "s", identity(R"([["a"]])")).setGrids({{"a"}, {"b"}});
  EXPECT_EQ(gridsOf(readIdentity(folder.path / "s")), (GridTexts{{"a"}, {"b"}}));
  EXPECT_EQ(gridsOf(open(R"([["a"]])")), (GridTexts{{"a"}, {"b"}})) << "begun again: goes on with all of them";
  EXPECT_EQ(gridsOf(open(R"([["a"], ["b"], ["c"]])")), (GridTexts{{"a"}, {"b"}, {"c"}}));
  EXPECT_EQ(gridsOf(readIdentity(folder.path / "s")), (GridTexts{{"a"}, {"b"}, {"c"}}));
  EXPECT_THROW(open(R"([["a"], ["x"]])"), UsageError);
}

TEST(Results, OfShardsMergeToTheWhole) {
  const StudyResults whole = someResults();
  StudyResults merged;
  for (size_t part = 0; part < 3; ++part) {
    StudyResults shard = whole;
    std::erase_if(shard.errors, [&](const ErrorRow& r) { return r.point % 3 != part; });
    std::erase_if(shard.times, [&](const TimeRow& r) { return r.point % 3 != part; });
    merge(merged, shard, "shard");
  }
  merge(merged, whole, "again");
  EXPECT_EQ(merged.errors.size(), whole.errors.size());
  EXPECT_EQ(merged.times.size(), whole.times.size());
  StudyResults other = whole;
  other.errors[0].relMse *= 1 + 1e-15;
  EXPECT_THROW(merge(merged, other, "other"), InputError) << "the same seed gives the same error to the last digit";
}

TEST(Results, HoldTheErrorsOfFacetsWhereThereAreAny) {
  TemporaryFolder folder;
  const StudyIdentity identity = R"({"scene": "box", "sweeps": [["a"]], "settings": {}})";
  StudyFolder written(folder.path / "s", identity);
  written.results = someResults();
  const double errors[] = {.03, .01, .02};
  for (size_t seed = 0; seed < 3; ++seed)
    written.results.errors[seed].hRelMse = errors[seed], written.results.errors[seed].hRmse = 10 * errors[seed];
  written.save();
  const StudyResults read = readResults(folder.path / "s");
  EXPECT_EQ(read.errors[1].hRelMse, .01) << "to the last bit";
  EXPECT_EQ(read.errors[2].hRmse, .2);
  EXPECT_TRUE(std::isnan(read.errors[3].hRelMse)) << "of another point, not measured";

  const std::vector<PointSummary> points = summarize(read, {"a", "b", "c"});
  EXPECT_NEAR(points[0].hRelMse.mean, .02, 1e-15);
  EXPECT_NEAR(points[0].hRelMse.half, 4.3027 * .01 / std::sqrt(3.0), 1e-6) << "t of 2 degrees of freedom x s / sqrt 3";
  EXPECT_TRUE(std::isnan(points[1].hRelMse.mean));
  EXPECT_TRUE(contains(pointTables(points, std::nullopt), "<th>relMSE of H</th>"));
  EXPECT_FALSE(contains(pointTables(summarize(someResults(), {"a", "b", "c"}), std::nullopt), "of H"));
  const std::string csv = pointsCsv(points, {"n"}, {{"16"}, {"32"}, {"64"}});
  EXPECT_TRUE(contains(csv, ",h_relmse,h_relmse_ci95,h_rmse,h_rmse_ci95,facets,")) << csv;
  EXPECT_TRUE(contains(csv, ",,,,,1000,20000,")) << "nothing where it was not measured: " << csv;

  StudyResults merged = read;
  merge(merged, read, "again");
  EXPECT_EQ(merged.errors.size(), read.errors.size());
  StudyResults other = read;
  other.errors[0].hRelMse *= 1 + 1e-15;
  EXPECT_THROW(merge(merged, other, "other"), InputError) << "the same seed gives the same error to the last digit";
  other.errors[0].hRelMse = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THROW(merge(merged, other, "other"), InputError);
}

TEST(Results, AreSummedUpByHand) {
  const std::vector<PointSummary> points = summarize(someResults(), {"a", "b", "c"});
  const PointSummary& b = points.at(1);
  EXPECT_EQ(b.seeds, 3u);
  EXPECT_NEAR(b.relMse.mean, .0101, 1e-15);
  EXPECT_NEAR(b.relMse.half, 4.3027 * .0001 / std::sqrt(3.0), 1e-8) << "t of 2 degrees of freedom x s / sqrt 3";
  EXPECT_DOUBLE_EQ(b.gpuMs("setup"), 42) << "the stages' sum without the wall, median of 40 to 44";
  EXPECT_DOUBLE_EQ(b.gpu.at("setup").p5, 40);
  EXPECT_DOUBLE_EQ(b.gpu.at("setup").p95, 44);
  EXPECT_DOUBLE_EQ(b.wall.at("setup").p50, 84);
  EXPECT_DOUBLE_EQ(b.firstPictureMs(), 42 + 3 + 1);
  EXPECT_DOUBLE_EQ(b.stages.at("setup").at("GI Voxelize").p50, 10.5);

  const std::vector<std::string> sentences = findings(points, someResults().peers, 2);
  ASSERT_EQ(sentences.size(), costKinds().size());
  EXPECT_TRUE(
      contains(sentences[1],
               "Build: 2 of 3 points are on the front, from relMSE 0.0337 at 12 ms with 0 (a) to 0.0101 at 42 ms "
               "with 1 (b). The settings given, 2 (c), are not: 1 (b) has 0.5 of their error for 0.512 of their "
               "ms."))
      << sentences[1];
  EXPECT_TRUE(contains(sentences[1], "with 1 (b). ") && !contains(sentences[1], "intervals overlap"));
  StudyResults noisy = someResults();
  noisy.errors[3].relMse *= 3;  // the first seed of b
  EXPECT_TRUE(
      contains(findings(summarize(noisy, {"a", "b", "c"}), {}, 2)[1], "of their error (their intervals overlap) for"))
      << findings(summarize(noisy, {"a", "b", "c"}), {}, 2)[1];
  // Between 8 and 200 samples the error falls as time^-1: .0101 after .4 x .125 / .0101 s.
  EXPECT_TRUE(contains(sentences[1], "The path tracer takes about 4950 ms")) << sentences[1];
}

TEST(Picking, TakesTheLeastErrorWithinABudgetOrTheLeastCostForAnError) {
  // First pictures 16, 46 and 86 ms, memory 10, 15 and 20 MiB, relMSE .0337, .0101 and .0202.
  std::vector<PointSummary> points = summarize(someResults(), {"a", "b", "c"});
  const CostKind& cost = costKinds().front();
  EXPECT_EQ(pick(points, cost, {.ms = 45}), 0u);
  EXPECT_EQ(pick(points, cost, {.ms = 46}), 1u);
  EXPECT_EQ(pick(points, cost, {.ms = 1000}), 1u) << "c is dearer and worse";
  EXPECT_EQ(pick(points, cost, {.ms = 1000, .mib = 12}), 0u);
  EXPECT_EQ(pick(points, cost, {.error = .05}), 0u) << "the cheapest that is good enough";
  EXPECT_EQ(pick(points, cost, {.error = .03}), 1u);
  EXPECT_EQ(pick(points, cost, {.ms = 15}), std::nullopt);
  EXPECT_EQ(pick(points, cost, {.error = .001}), std::nullopt);
  points[1].failure = "no memory";
  EXPECT_EQ(pick(points, cost, {.ms = 1000}), 2u) << "not what could not be computed";
}

TEST(Slopes, AreThoseOfTheFrontsNextStep) {
  // Errors fall as cost^-2 from 1 to 2, then as cost^-1; the last is dominated by the second.
  const std::vector<CostAndError> points{{10, .4}, {20, .1}, {40, .05}, {30, .2}};
  const Slope first = slopeAt(points, 0);
  EXPECT_EQ(first.better, std::nullopt);
  EXPECT_EQ(first.next, 1u);
  EXPECT_NEAR(first.exponent, 2, 1e-12);
  EXPECT_NEAR(first.errorFor(points[0], 1), .4 / (1.1 * 1.1), 1e-12) << "one more on ten";
  EXPECT_NEAR(first.errorFor(points[0], 10), .1, 1e-12) << "the whole step";
  const Slope last = slopeAt(points, 2);
  EXPECT_EQ(last.better, std::nullopt);
  EXPECT_EQ(last.next, std::nullopt) << "nothing is better";
  const Slope off = slopeAt(points, 3);
  EXPECT_EQ(off.better, 1u) << "less error for less";
  EXPECT_EQ(off.next, 2u);
  EXPECT_NEAR(off.exponent, std::log(4) / std::log(40.0 / 30), 1e-12);
}

TEST(Slopes, AgreeWithBruteForceOnRandomPoints) {
  std::mt19937 random(7);
  std::uniform_real_distribution<double> log(-3, 3);
  for (int round = 0; round < 200; ++round) {
    std::vector<CostAndError> points;
    for (int i = 0; i < 12; ++i) points.push_back({std::exp(log(random)), std::exp(log(random))});
    for (size_t at = 0; at < points.size(); ++at) {
      // Better: of those that cost no more the least error. Next: of those with less error than both the cheapest.
      std::optional<size_t> better, next;
      for (size_t i = 0; i < points.size(); ++i)
        if (points[i].cost <= points[at].cost && points[i].error < points[at].error &&
            (!better || points[i].error < points[*better].error))
          better = i;
      const double bar = better ? points[*better].error : points[at].error;
      for (size_t i = 0; i < points.size(); ++i)
        if (points[i].error < bar && (!next || points[i].cost < points[*next].cost)) next = i;
      const Slope slope = slopeAt(points, at);
      EXPECT_EQ(slope.better, better);
      EXPECT_EQ(slope.next, next);
    }
  }
}

TEST(Places, AreThePointItselfOrTheNearestInWords) {
  Settings base;
  base.matrix.gpu.rays = 64;
  const SettingGrid grid(kSweep, base);
  std::vector<Settings> points;
  for (size_t i = 0; i < grid.size(); ++i) points.push_back(grid.settings(i));
  std::vector<bool> usable(3, true);
  Settings now = grid.settings(1);
  now.view.facet = 7, now.matrix.gpu.seed = 9, now.camera.exposureEv = 2, now.solver.sweepsPerFrame = 3;
  std::optional<PlaceInStudy> place = placeOf(points, usable, now);
  ASSERT_TRUE(place);
  EXPECT_EQ(place->point, 1u);
  EXPECT_TRUE(place->apart.empty()) << "what a picture is shown by and seeds do not count";
  now.voxel.resolution = 48;  // a factor 1.5 from 32, 1.33 from 64
  now.matrix.gpu.rays = 128;
  place = placeOf(points, usable, now);
  EXPECT_EQ(place->point, 2u);
  EXPECT_EQ(place->apart,
            (std::vector<std::string>{"voxel.resolution 64 instead of 48", "matrix.rays 64 instead of 128"}));
  usable[2] = false;
  EXPECT_EQ(placeOf(points, usable, now)->point, 1u) << "a point that failed is no place";
  EXPECT_EQ(placeOf(points, {false, false, false}, now), std::nullopt);
}

TEST(LoadedStudies, AreWhatTheirFoldersSay) {
  const TemporaryFolder folder;
  Settings base;
  base.matrix.gpu.rays = 96;
  const std::string identity = R"({"study": "cost", "scene": "a.glb", "scene_sha256": "abc", "device": "D",
    "view": "indirect", "size": [64, 48], "sweeps": [["voxel.resolution=16,32,64"]], "settings": )" +
                               settingsToJson(base) + "}";
  StudyFolder made(folder.path / "study", identity);
  made.results = someResults();
  made.results.failures.push_back({2, "no memory"});
  made.save();
  LoadedStudy study = loadStudy(folder.path / "study");
  EXPECT_EQ(study.scene, "a.glb");
  EXPECT_EQ(study.size, glm::uvec2(64, 48));
  ASSERT_EQ(study.points.size(), 3u);
  EXPECT_EQ(study.points[1].label, "voxel.resolution=32");
  EXPECT_NEAR(study.points[1].relMse.mean, .0101, 1e-15);
  EXPECT_EQ(study.settings[1].voxel.resolution, 32u);
  EXPECT_EQ(study.settings[1].matrix.gpu.rays, 96u);
  EXPECT_EQ(study.measured(), (std::vector<bool>{true, true, false}));
  EXPECT_TRUE(study.stages.empty());

  // Attribution beside it, or alone: columns by name, rows without a number left out.
  writeFile(
      folder.path / "study/attribution.csv",
      "ms,row,words,relmse,gain\n1,picture,,0.06,\n1,model,,0.01,\n1,voxels,,0.06,0.02\n2,rays,\"a, b\",0.06,0.03\n"
      "3,rays.bias,,0.06,0.5\n3,sweeps,,0.06,\n3,rest,,0.06,0.9\n");
  study = loadStudy(folder.path / "study");
  EXPECT_EQ(study.points.size(), 3u);
  ASSERT_EQ(study.stages.size(), 3u);
  EXPECT_EQ(study.stages[0].stage, "rays");
  EXPECT_EQ(study.stages[0].relMse, .03);
  EXPECT_EQ(study.stages[2].stage, "model");
  EXPECT_EQ(study.stages[2].relMse, .01);
  makeFolder(folder.path / "alone");
  std::filesystem::copy_file(folder.path / "study/attribution.csv", folder.path / "alone/attribution.csv");
  study = loadStudy(folder.path / "alone");
  EXPECT_TRUE(study.points.empty());
  EXPECT_EQ(study.stages.size(), 3u);
}

TEST(LoadedStudies, SayWhatDoesNotHoldForAPicture) {
  Camera camera;
  camera.position = {1, 2, 3};
  LoadedStudy study;
  EXPECT_TRUE(misfit(study, "abc", camera, {640, 480}).usable()) << "the folder says nothing";
  study.scene = "box.glb", study.sceneSha256 = "abc", study.camera = cameraToJson(camera), study.size = {640, 480};
  Misfit m = misfit(study, "abc", camera, {640, 480});
  EXPECT_TRUE(m.usable() && m.size.empty());
  EXPECT_EQ(misfit(study, "abd", camera, {640, 480}).scene, "box.glb");
  EXPECT_FALSE(misfit(study, "abd", camera, {640, 480}).usable());
  m = misfit(study, "abc", camera, {320, 480});
  EXPECT_TRUE(m.usable());
  EXPECT_EQ(m.size, "640 \u00D7 480 pixels, not 320 \u00D7 480");

  const auto other = [&](const std::function<void(Camera&)>& change) {
    Camera c = camera;
    change(c);
    const Misfit of = misfit(study, "abc", c, {640, 480});
    EXPECT_EQ(of.usable(), of.camera.empty());
    return of.camera;
  };
  EXPECT_EQ(other([](Camera& c) { c.position.y += .01; }), "it stands at 1 2 3, not 1 2.01 3");
  EXPECT_TRUE(contains(other([](Camera& c) { c.orientation = {.9998f, 0, .02f, 0}; }), "it looks along "));
  EXPECT_TRUE(contains(other([](Camera& c) { c.orientation = {.8f, 0, 0, .6f}; }), "is rolled"));
  EXPECT_TRUE(contains(other([](Camera& c) { c.yfov = .9f; }), "its vertical angle is 57.30 degrees, not 51.57"));
  EXPECT_EQ(other([](Camera& c) { c.orthographic = true; }), "it is perspective");
  // What a window's turns make of the same camera, and what is not seen.
  EXPECT_EQ(other([](Camera& c) {
              c.name = "b", c.znear = .2f, c.position.x += 1e-9, c.orientation = {-1, 1e-7f, 0, 0};
            }),
            "");
  study.camera = "{}";
  EXPECT_FALSE(misfit(study, "abc", camera, {640, 480}).usable());
}

TEST(LoadedStudies, SayWhatIsWrongWithAFolder) {
  const TemporaryFolder folder;
  const auto refusal = [&](const std::string& file, const std::string& text) -> std::string {
    const fs::path at = folder.path / "study";
    fs::remove_all(at);
    makeFolder(at);
    writeFile(at / file, text);
    try {
      loadStudy(at);
    } catch (const InputError& error) {
      return error.what();
    }
    return "";
  };
  EXPECT_TRUE(contains(refusal("other.txt", ""), "study.json: no such file"));
  EXPECT_TRUE(contains(refusal("study.json", "[1]"), "expected a JSON object"));
  EXPECT_TRUE(contains(refusal("study.json", "{}"), "study.json: "));
  EXPECT_TRUE(contains(refusal("study.json", R"({"settings": {}, "sweeps": [["voxel.resolution=3"]]})"),
                       "voxel.resolution: '3' is not allowed"));
  EXPECT_TRUE(contains(refusal("attribution.csv", "stage,error\n"), "attribution.csv: no column 'relmse'"));
}

TEST(Ahead, PointsBetweenTwoThatWereTriedGrowAsIsKnown) {
  using app::PictureTrial, app::pointFactors;
  const SettingGrid grid(std::vector<std::string>{"voxel.resolution=16,32,64", "matrix.rays=32,128"}, Settings{});
  std::vector<size_t> points(grid.size());
  std::iota(points.begin(), points.end(), 0);
  const auto grown = [](double n, double r) { return std::pow(n, 1.93) * std::pow(r, .93); };
  // Half of the first is the matrix; the last takes what that grows to.
  PictureTrial first{.error = 3, .timed = 2, .parts = {0, 0, 1, 0}}, last = first;
  last.timed = 1 + grown(4, 4);
  const std::vector<double> factors = pointFactors(grid, points, first, last);
  for (size_t i = 0; i < points.size(); ++i) {
    const Settings s = grid.settings(i);
    EXPECT_NEAR(factors[i], .5 + .5 * grown(s.voxel.resolution / 16.0, s.matrix.gpu.rays / 32.0), 1e-9) << i;
  }
  // The last one is what it is; those between follow it.
  last.timed = 20;
  const std::vector<double> less = pointFactors(grid, points, first, last);
  EXPECT_DOUBLE_EQ(less.front(), 1);
  EXPECT_NEAR(less.back(), 10, 1e-9);
  for (size_t i = 1; i < points.size(); ++i) EXPECT_LT(less[i], factors[i]);
  // Settings whose growth nobody knows: as long as the two on average.
  const SettingGrid other(std::vector<std::string>{"solver.tolerance=0.01,0.001,0.0001"}, Settings{});
  EXPECT_EQ(pointFactors(other, {0, 1, 2}, first, last), (std::vector<double>{5.5, 5.5, 5.5}));
  // One alone, and one that found no memory, tell of themselves.
  EXPECT_EQ(pointFactors(other, {0}, first, first), std::vector<double>{1});
  EXPECT_EQ(pointFactors(grid, {0, 5}, first, {})[1], 1);
  EXPECT_EQ(pointFactors(grid, {0, 5}, {}, last)[1], 1);
}

TEST(Ahead, FramesOfBruteForceAreRepeatsOfEachOther) {
  Settings settings;
  EXPECT_EQ(app::timedRepeats(settings, 30), 30u);
  app::StudyTask task;
  task.seeds = 4, task.repeats = 30;
  const auto missing = [&](const StudyResults& there) { return app::picturesMissing(there, 0, settings, 7, task); };
  EXPECT_EQ(missing({}).timed, 31);  // with the round that warms up
  EXPECT_EQ(missing({}).frames, 0);

  settings.solver.method = SolverMethod::bruteForce;
  const auto repeats = [&](uint32_t frames, uint32_t others) {
    settings.solver.frames = frames;
    return app::timedRepeats(settings, others);
  };
  EXPECT_EQ(repeats(1, 30), 30u);
  EXPECT_EQ(repeats(4, 30), 8u);
  EXPECT_EQ(repeats(64, 30), 3u);
  EXPECT_EQ(repeats(64, 2), 2u);
  settings.solver.frames = 64;
  EXPECT_EQ(missing({}).errors, 4);
  EXPECT_EQ(missing({}).timed, 4);
  EXPECT_EQ(missing({}).frames, 7 * 63);  // of four seeds and three repeats; what warms up has one
  EXPECT_EQ(app::withOneFrame(settings).solver.frames, 1u);
  StudyResults some;
  for (uint32_t i = 0; i < 3; ++i) some.times.push_back({0, i, "relight", "GI Solve", 1});
  EXPECT_EQ(missing(some).timed, 0);
}

TEST(Results, AsTablesNameFailuresAndDominators) {
  StudyResults results = someResults();
  std::erase_if(results.errors, [](const ErrorRow& r) { return r.point == 2; });
  results.failures.push_back({2, "the matrix needs 9.0 MiB, 1.0 MiB are free"});
  const SettingGrid grid(kSweep, Settings{});
  const std::string csv =
      pointsCsv(summarize(results, {"a", "b", "c"}), {"voxel.resolution"}, {{"16"}, {"32"}, {"64"}});
  EXPECT_TRUE(contains(csv, "\n2,64,\"the matrix needs 9.0 MiB, 1.0 MiB are free\",0,")) << csv;
  EXPECT_TRUE(contains(csv, "\n0,16,done,3,")) << csv;
  EXPECT_TRUE(contains(csv, ",front,front,")) << csv;
  EXPECT_TRUE(contains(stagesCsv(summarize(results, {"a", "b", "c"})),
                       "1,setup,\"GI, Build \"\"Matrix\"\"\",30.0000,31.5000,33.0000,5\n"));
}

/// A report as `irad study cost` writes it, with pictures where this build writes PNG.
fs::path report(const fs::path& folder) {
  fs::create_directories(folder / "pictures");
  const glm::uvec2 size(48, 32);
  for (const std::string& name :
       {std::string(kReferenceName), pictureName(0), pictureName(1), pictureName(2), pictureName("path-tracer", 8),
        pictureName("path-tracer", 200), pictureName("path-tracer", 2)}) {
    std::vector<glm::u8vec4> pixels;
    for (uint32_t i = 0; i < size.x * size.y; ++i) pixels.emplace_back(i % 256, (i * name.size()) % 256, 128, 255);
    writeDisplay(folder / "pictures" / name, size, pixels);
  }
  Settings given;
  given.voxel.resolution = 64;
  writeReport(folder, SettingGrid(kSweep, given), someResults(),
              {.facts = {"Scene <box> & others"}, .pictureSize = size, .cropAt = {8, 8}, .cropSize = {24, 16}});
  return folder / "report.html";
}

TEST(Tuning, MeasuresHalfWayToTheNeighboursAndBeyondTheEnds) {
  const std::vector<std::string> sweeps{"voxel.resolution=16,64", "matrix.rays=32,64,128", "matrix.traversal=dda,sdf"};
  const SettingGrid grid(sweeps, Settings{});
  const auto pointAt = [&](const std::vector<std::string>& values) {
    for (size_t i = 0; i < grid.size(); ++i)
      if (grid.values(i) == values) return i;
    return size_t{0};
  };
  EXPECT_EQ(around(grid, pointAt({"64", "64", "sdf"})),
            (std::vector<std::string>{"voxel.resolution=64,32,256", "matrix.rays=64,45,91", "matrix.traversal=sdf"}));
  EXPECT_EQ(around(grid, pointAt({"16", "32", "dda"})),
            (std::vector<std::string>{"voxel.resolution=16,8,32", "matrix.rays=32,16,45", "matrix.traversal=dda"}))
      << "16 x 16 / 64 is below the range, which ends at 8";
  const std::vector<std::string> fixed{"voxel.resolution=64", "matrix.traversal=dda,sdf"};
  EXPECT_TRUE(around(SettingGrid(fixed, Settings{}), 0).empty()) << "one value alone is not varied";

  // Halving ends.
  SettingGrid closing(std::vector<std::string>{"matrix.rays=32,64"}, Settings{});
  size_t rounds = 0;
  for (std::vector<std::string> next = around(closing, 0); !next.empty() && rounds < 100; next = around(closing, 0)) {
    closing.add(next);
    ++rounds;
  }
  EXPECT_LT(rounds, 20u);
  for (size_t i = 1; i < closing.size(); ++i) EXPECT_NE(closing.values(i), closing.values(0));
}

TEST(Tuning, GoesOnFromTheNearestWhereNothingIsWithinTheBudget) {
  const std::vector<PointSummary> points = summarize(someResults(), {"a", "b", "c"});
  const CostKind& build = costKinds()[1];
  EXPECT_EQ(nearest(points, build, {.ms = 50}), 1u) << "as pick";
  EXPECT_EQ(nearest(points, build, {.ms = 1}), 0u);
  EXPECT_EQ(nearest(points, build, {.error = 1e-9}), 1u);
  EXPECT_EQ(nearest(points, build, {.mib = 1}), 0u);
  EXPECT_EQ(nearest({}, build, {.ms = 1}), std::nullopt);
}

TEST(Tuning, PromisesByWhatHadNoPartInTheChoice) {
  const StudyResults all = someResults();  // seeds 0 to 2, repeats 0 to 4
  const StudyResults chosen = chosenBy(all, 0, 2, 4), rest = unseen(all, 0, 2, 4);
  EXPECT_EQ(chosen.errors.size(), 6u);
  EXPECT_EQ(rest.errors.size(), 3u);
  for (const ErrorRow& r : rest.errors) EXPECT_EQ(r.seed, 2u);
  EXPECT_EQ(chosen.times.size() + rest.times.size(), all.times.size());
  for (const TimeRow& r : rest.times) EXPECT_EQ(r.repeat, 4u);
}

TEST(Reports, StandByThemselves) {
  TemporaryFolder folder;
  const std::string html = slurp(report(folder.path));
  EXPECT_TRUE(contains(html, "Scene &lt;box&gt; &amp; others"));
  EXPECT_FALSE(contains(html, "<script"));
  for (const char* outside : {"src=\"http", "href=\"http", "url(", "href=\"/", "src=\"/"})
    EXPECT_FALSE(contains(html, outside)) << outside;
  EXPECT_TRUE(contains(html, "dominated by 1 (voxel.resolution=32)")) << "under the pointer, in the plots";
  EXPECT_TRUE(contains(html, "voxel.resolution=64 (given)"));
  // A sentence per plot, of its own figures: those of errors, and of stages (12 to 82 ms, three quarters the matrix).
  for (const char* sentence :
       {"First picture: 2 of 3 points are on the front", "Build: 2 of 3 points are on the front",
        "Relight: 1 of 3 points is on the front", "Frame: 1 of 3 points is on the front",
        "Memory: 2 of 3 points are on the front",
        "<p class=\"finding\">Build: 12 ms at point 0, 75 % of it GI, Build &quot;Matrix&quot;; 82 ms at point 2, 75 % "
        "of it GI, Build &quot;Matrix&quot;.</p>",
        "<p class=\"finding\">Relight: 2 ms at point 0, 100 % of it GI Solve.</p>",
        "<p class=\"finding\">Frame: 1 ms at point 0, 100 % of it Forward.</p>"})
    EXPECT_TRUE(contains(html, sentence)) << sentence;
  for (const char* name : {"points.csv", "stages.csv", "error-against-first_picture.svg", "error-against-build.svg",
                           "error-against-memory.svg", "stages-setup.svg"})
    EXPECT_TRUE(fs::exists(folder.path / name)) << name;
  if (fs::exists(folder.path / "pictures/reference.png")) {
    EXPECT_TRUE(contains(html, "Equal time"));
    EXPECT_TRUE(contains(html, "href=\"data:image/png;base64,iVBORw0KGgo")) << "PNG's first bytes";
  }
}

TEST(Reports, ShowErrorsBesideMillisecondsOfPointsThatWereSplit) {
  TemporaryFolder folder;
  EXPECT_TRUE(contains(slurp(report(folder.path)), "Not measured: --split N"));
  Attribution split;
  for (size_t i = 0; i < kErrorStages; ++i) split.stages.push_back({.stage = static_cast<ErrorStage>(i)});
  const auto stage = [&](ErrorStage s) -> StageError& {
    StageError& out = split.stages[static_cast<size_t>(s)];
    out.presence.present = true;
    return out;
  };
  split.asIs = {.01, .001};
  split.model.mean = .001;
  stage(ErrorStage::voxels).step.mean = .007, stage(ErrorStage::voxels).cost = {.buildMs = 1, .relightMs = 1};
  stage(ErrorStage::rays).step.mean = .002, stage(ErrorStage::rays).cost.buildMs = 6;
  split.other.frameMs = 2;
  writeReport(folder.path, SettingGrid(kSweep, Settings{}), someResults(), {}, {{1, split}});
  const std::string html = slurp(folder.path / "report.html");
  EXPECT_TRUE(
      contains(html,
               "<p class=\"finding\">Point 1: of relMSE 0.01 ± 0.001 every stage ideal leaves 10 %; voxels adds "
               "most, 70 %, and takes 20 % of 10 ms; rays takes most, 60 % of 10 ms, and adds 20 %.</p>"))
      << html;
  const std::string errors = slurp(folder.path / "split-errors.svg"), times = slurp(folder.path / "split-times.svg");
  EXPECT_TRUE(contains(errors, "<title>rays: 0.002 relMSE</title>")) << errors;
  EXPECT_TRUE(contains(times, "<title>rays: 6 ms</title>")) << times;
  for (const std::string& plot : {errors, times}) {
    for (const char* name : {">voxels<", ">rays<", ">model<", ">other<"}) EXPECT_TRUE(contains(plot, name)) << name;
    EXPECT_FALSE(contains(plot, ">shadows<")) << "it has neither";
  }
}

/// Of one colour in each layer, 16 x 8 pixels.
fs::path layered(const fs::path& stem, const std::vector<std::pair<std::string, float>>& values) {
  std::vector<PictureLayer> layers;
  for (const auto& [name, value] : values) layers.push_back({name, std::vector<glm::vec4>(128, glm::vec4(value))});
  return writeLayers(stem, {16, 8}, layers, {"", "lit"}).front();
}

TEST(Layers, AreComparedBounceByBounce) {
  TemporaryFolder folder;
  // A picture that is right in sum, and wrong in its parts; two references about the truth 1 and 0.5.
  const fs::path picture = layered(folder.path / "picture", {{"", 1.5f}, {"bounce.0", 1.1f}, {"bounce.1", .35f}}),
                 first = layered(
                     folder.path / "first",
                     {{"", 1.7f}, {"error", .1f}, {"bounce.0", 1.2f}, {"bounce.0.error", .1f}, {"bounce.1", .5f}}),
                 second = layered(
                     folder.path / "second",
                     {{"", 1.3f}, {"error", .1f}, {"bounce.0", .8f}, {"bounce.0.error", .1f}, {"bounce.1", .5f}});
  const LayeredPicture p = readLayers(picture), r = readLayers(first), s = readLayers(second);
  const std::vector<LayerError> layers = compareLayers(p, r, &s);
  ASSERT_EQ(layers.size(), 3u) << "and none of the standard errors";
  EXPECT_EQ(layers[0].name, "lit");
  EXPECT_EQ(layers[2].name, "bounce.1");
  EXPECT_NEAR(layers[1].metrics.blockRelMse, (1.1 - 1.2) * (1.1 - .8) / 1.01, 1e-6);
  EXPECT_NEAR(layers[1].metrics.pixels.meanError, .1, 1e-6);
  EXPECT_NEAR(layers[2].metrics.blockRelMse, .15 * .15 / (.25 * 1.01), 1e-6);
  EXPECT_NEAR(layers[2].metrics.pixels.meanError, -.15, 1e-6);
  // Half an interval by the noise of both, e = 0.1 / 8 / sqrt 2 of a block's mean: none of the product is above 0.
  EXPECT_NEAR(layers[1].metrics.blockRelMseHalf, 1.96 * std::sqrt(4.0 / 6) * (.01 / 128) / 1.01, 1e-7);
  EXPECT_TRUE(std::isnan(layers[2].metrics.blockRelMseHalf));
  EXPECT_NEAR(compareLayers(p, r)[1].metrics.blockRelMse, .01 / (1.44 * 1.01), 1e-6);

  const RunResult run =
      runIrad({"study", "compare", picture.string(), first.string(), "--second-reference", second.string()});
  ASSERT_EQ(run.status, 0) << run.err;
  EXPECT_TRUE(contains(run.out, "bounce.1   0.5   0.0891")) << run.out;
  EXPECT_TRUE(contains(run.out, "bounce.1 has most among the 2 bounces, -0.15; +0.05 is of more ")) << run.out;
  writeLayers(folder.path / "other", {8, 8}, std::vector<PictureLayer>{{"", std::vector<glm::vec4>(64)}});
  const RunResult refused = runIrad(
      {"study", "compare", picture.string(), (folder.path / ("other" + std::string(linearExtension()))).string()});
  EXPECT_EQ(refused.status, 2);
  EXPECT_TRUE(contains(refused.err, "pictures of 16 x 8 and of 8 x 8 pixels")) << refused.err;
}

#ifdef IRAD_OIIO
TEST(Layers, OfIntegersAreDecodedAsReferencesAre) {
  TemporaryFolder folder;
  const fs::path linear = layered(folder.path / "linear", {{"", .5f}}),
                 shown =
                     writeDisplay(folder.path / "shown", {16, 8}, std::vector<glm::u8vec4>(128, {188, 188, 188, 255}));
  const RunResult run = runIrad({"study", "compare", linear.string(), shown.string()});
  ASSERT_EQ(run.status, 0) << run.err;
  EXPECT_TRUE(contains(run.err, "shown.png holds integers and is decoded from sRGB")) << run.err;
  EXPECT_TRUE(contains(run.out, "lit    0.503")) << run.out;  // 188 / 255 decoded; taken as it is it would be 0.737
}
#endif

TEST(Reports, ShowPicturesOfBuildsThatWriteNoPng) {
  TemporaryFolder folder;
  std::vector<uint8_t> pixels(18);
  std::iota(pixels.begin(), pixels.end(), uint8_t{1});
  writeNpy<uint8_t>(folder.path / "p.npy", {2, 3, 3}, pixels);
  const PicturePart all{{3, 2}, {0, 0}, {3, 2}};
  // A bitmap: the last row first, blue before red, rows filled up to four bytes.
  EXPECT_TRUE(contains(htmlFigure(folder.path / "p", all, "p"),
                       "href=\"data:image/bmp;base64,Qk1OAAAAAAAAADYAAAAoAAAAAwAAAAIAAAABABgAAAAAAAAAAAAAAAAAAAAA"
                       "AAAAAAAAAAAADAsKDw4NEhEQAAAAAwIBBgUECQgHAAAA\""));
  EXPECT_EQ(htmlFigure(folder.path / "q", all, "p"), "");
}

TEST(Reports, OpenInABrowser) {
  if (std::system("command -v chromium > /dev/null 2>&1") != 0)
    GTEST_SKIP() << "chromium is not installed: nobody looks at the report";
  TemporaryFolder folder;
  const fs::path page = report(folder.path), shot = folder.path / "shot.png";
  const RunResult run =
      runProgram("/usr/bin/env",
                 {"HOME=" + folder.path.string(), "chromium", "--headless", "--no-sandbox", "--disable-gpu",
                  "--enable-logging=stderr", "--window-size=1240,3600", "--dump-dom", "file://" + page.string()},
                 120);
  EXPECT_EQ(run.status, 0) << run.err;
  EXPECT_TRUE(contains(run.out, "</html>"));
  EXPECT_FALSE(contains(run.err, "CONSOLE")) << "the page complains:\n" << run.err;
  const RunResult picture = runProgram(
      "/usr/bin/env",
      {"HOME=" + folder.path.string(), "chromium", "--headless", "--no-sandbox", "--disable-gpu", "--hide-scrollbars",
       "--window-size=1240,3600", "--screenshot=" + shot.string(), "file://" + page.string()},
      120);
  EXPECT_EQ(picture.status, 0) << picture.err;
  EXPECT_GT(slurp(shot).size(), 50'000u) << "an empty page is smaller";

  // No picture is missing: the browser decodes each of a copy of the page, and writes how many it could into the title.
  const std::string html = slurp(page);
  size_t pictures = 0;
  for (size_t at = 0; (at = html.find("<image ", at)) != std::string::npos; ++at) ++pictures;
  EXPECT_GE(pictures, 4u) << "crops of equal time and of equal error";
  const fs::path counting = folder.path / "counting.html";
  writeFile(counting, html +
                          "<script>Promise.all([...document.querySelectorAll('image')].map(e => { const i = new "
                          "Image(); i.src = e.getAttribute('href'); return i.decode().then(() => 1, () => 0); }))"
                          ".then(all => document.title = all.reduce((a, b) => a + b) + ' pictures decoded');"
                          "</script>\n");
  const RunResult counted =
      runProgram("/usr/bin/env",
                 {"HOME=" + folder.path.string(), "chromium", "--headless", "--no-sandbox", "--disable-gpu",
                  "--virtual-time-budget=20000", "--dump-dom", "file://" + counting.string()},
                 120);
  EXPECT_EQ(counted.status, 0) << counted.err;
  EXPECT_TRUE(contains(counted.out, fmt::format("<title>{} pictures decoded</title>", pictures)))
      << counted.out.substr(0, 300);
}

TEST(Plots, AreWholeXmlWithinTheirFrame) {
  const std::string plot = logPlot("x", "y", {{"one & only", PlotStyle::Front, {{1, 1, 1, 1, 1, 1, "0", "<hint>"}}}});
  EXPECT_TRUE(contains(plot, "one &amp; only"));
  EXPECT_TRUE(contains(plot, "<title>&lt;hint&gt;</title>"));
  EXPECT_FALSE(contains(plot, "nan"));
  EXPECT_FALSE(contains(plot, "inf"));
  EXPECT_FALSE(contains(logPlot("x", "y", {}), "nan")) << "nothing to show is no mistake";
  EXPECT_FALSE(contains(stackedBars("ms", {}, {}), "nan"));
  EXPECT_TRUE(contains(stackedBars("ms", {"a"}, {{"row", {2}}}), "a: 2 ms"));
}

}  // namespace
}  // namespace irad::test::study_suite
