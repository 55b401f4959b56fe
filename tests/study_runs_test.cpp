// `irad study` from outside: a study that is killed goes on, shards merge to the whole, points without memory are rows,
// and references that do not fit are refused; Ctrl+C ends it with whole files.
#include <fmt/format.h>
#include <signal.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <fstream>
#include <functional>
#include <memory>
#include <thread>

#include "gi/check/families.h"
#include "gi/check/glb.h"
#include "gi/check/path_state.h"
#include "gi/check/path_tracer.h"
#include "gi/check/process.h"
#include "gi/study/results.h"
#include "gi/study/sweep.h"
#include "renderer/base/image_io.h"
#include "renderer/scene/scene.h"
#include "tests/support.h"

namespace irad::test::study_runs_suite {
namespace {

namespace fs = std::filesystem;

class StudyRuns : public ::testing::Test {
 protected:
  /// A picture of the program's own as reference: rendered with more voxels and rays.
  static void SetUpTestSuite() {
    truth_ = std::make_unique<TemporaryFolder>();
    const RunResult run =
        runIrad({"render", "box", "--size", "32x24", "--set", "voxel.resolution=12", "--set", "matrix.rays=32", "--set",
                 "light.shadow_resolution=64", "--out", truth_->path.string()});
    ASSERT_EQ(run.status, 0) << run.err;
    for (const char* name : {"lit.exr", "lit.pfm"})
      if (fs::exists(truth_->path / name)) reference_ = truth_->path / name;
  }
  static void TearDownTestSuite() { truth_.reset(); }
  std::vector<std::string> study(const std::string& out, const std::vector<std::string>& more = {}) const {
    std::vector<std::string> arguments{"study", "cost", "box", "--seeds", "2", "--sweep", "matrix.rays=8..16*2"};
    for (const char* setting : {"voxel.resolution=8", "light.shadow_resolution=64"})
      arguments.insert(arguments.end(), {"--set", setting});
    arguments.insert(arguments.end(), {"--reference", reference_.string(), "--out", (folder_.path / out).string()});
    arguments.insert(arguments.end(), more.begin(), more.end());
    return arguments;
  }
  std::string file(const std::string& out, const std::string& name) const { return slurp(folder_.path / out / name); }

  TemporaryFolder folder_;
  static inline std::unique_ptr<TemporaryFolder> truth_;
  static inline fs::path reference_;
};

TEST_F(StudyRuns, AKilledStudyGoesOnAndShardsMergeToTheSameErrors) {
  const RunResult whole = runIrad(study("whole", {"--repeats", "1"}));
  ASSERT_EQ(whole.status, 0) << whole.err;
  EXPECT_TRUE(contains(whole.out, "Build: ")) << whole.out;
  const StudyResults results = readResults(folder_.path / "whole");
  ASSERT_EQ(results.errors.size(), 4u);
  for (const ErrorRow& r : results.errors) {
    EXPECT_GT(r.relMse, 0);
    EXPECT_GT(r.facets, 0u);
    EXPECT_GT(r.deviceMib, r.matrixMib);
  }
  EXPECT_NE(results.errors[0].relMse, results.errors[1].relMse) << "of two seeds";
  for (const char* name : {"report.html", "points.csv", "stages.csv", "error-against-build.svg"})
    EXPECT_TRUE(fs::exists(folder_.path / "whole" / name)) << name;

  // Killed when some errors are there.
  const auto rows = [&] {
    const std::string text = file("killed", "errors.csv");
    return std::ranges::count(text, '\n');
  };
  bool killed = false;
  {
    Process process(iradProgram(), study("killed", {"--repeats", "1"}));
    while (!killed && !process.poll()) {
      if (rows() > 2) killed = process.kill() == 128 + SIGKILL;
      std::this_thread::sleep_for(std::chrono::milliseconds(1));
    }
  }
  EXPECT_TRUE(killed);
  EXPECT_LT(rows(), 5) << "killed too late to show anything";
  EXPECT_TRUE(file("whole", "errors.csv").starts_with(file("killed", "errors.csv"))) << "what is there is whole";
  EXPECT_FALSE(fs::exists(folder_.path / "killed/report.html"));
  const RunResult rest = runIrad(study("killed", {"--repeats", "1"}));
  ASSERT_EQ(rest.status, 0) << rest.err;
  EXPECT_EQ(file("killed", "errors.csv"), file("whole", "errors.csv")) << "the same to the last digit";

  // What is done is not done again: with another repeat the times of the first stay.
  const std::vector<TimeRow> before = readResults(folder_.path / "killed").times;
  ASSERT_EQ(runIrad(study("killed", {"--repeats", "2"})).status, 0);
  StudyResults more = readResults(folder_.path / "killed");
  EXPECT_TRUE(more.hasTimes(0, 1) && more.hasTimes(1, 1) && !more.hasTimes(1, 2));
  std::erase_if(more.times, [](const TimeRow& r) { return r.repeat > 0; });
  EXPECT_TRUE(std::ranges::equal(more.times, before, {}, &TimeRow::ms, &TimeRow::ms));

  for (const char* shard : {"1/2", "2/2"})
    ASSERT_EQ(runIrad(study(std::string("shard") + shard[0], {"--repeats", "1", "--shard", shard})).status, 0);
  EXPECT_NE(file("shard1", "errors.csv"), file("whole", "errors.csv"));
  const std::string shards[] = {(folder_.path / "shard1").string(), (folder_.path / "shard2").string()};
  const RunResult merged =
      runIrad({"study", "merge", shards[0], shards[1], "--out", (folder_.path / "merged").string()});
  ASSERT_EQ(merged.status, 0) << merged.err;
  EXPECT_EQ(file("merged", "errors.csv"), file("whole", "errors.csv"));
  EXPECT_TRUE(contains(file("merged", "report.html"), "Where the milliseconds go"));

  // What is picked can be rendered.
  const RunResult picked = runIrad({"study", "pick", (folder_.path / "merged").string(), "--target-error", "1000"});
  ASSERT_EQ(picked.status, 0) << picked.err;
  EXPECT_TRUE(contains(picked.out, "point       ") && contains(picked.out, "build       ")) << picked.out;
  const RunResult rendered =
      runIrad({"render", "box", "--size", "16x16", "--config", (folder_.path / "merged/picked.json").string(), "--out",
               (folder_.path / "rendered").string()});
  EXPECT_EQ(rendered.status, 0) << rendered.err;
  const RunResult none = runIrad({"study", "pick", (folder_.path / "merged").string(), "--budget-ms", "1e-6"});
  EXPECT_EQ(none.status, 1);
  EXPECT_TRUE(contains(none.err, "none of its 2 points is within that")) << none.err;

  // What another program has measured is not gone on with: its rows would stand in one table with those of this one.
  const std::string ours = file("killed", "study.json"), member = "\"program\": \"";
  const size_t at = ours.find(member) + member.size(), end = ours.find('"', at);
  ASSERT_TRUE(contains(ours, member));
  const std::string version = runIrad({"--version"}).out;  // "irad 0.1.0 (commit)"
  EXPECT_TRUE(ours.substr(at, end - at).starts_with(version.substr(5, version.find(')') - 5))) << ours << version;
  std::ofstream(folder_.path / "killed/study.json") << std::string(ours).replace(at, end - at, "0.1.0 (0123456789ab)");
  const RunResult elder = runIrad(study("killed", {"--repeats", "2"}));
  EXPECT_EQ(elder.status, 2);
  EXPECT_TRUE(contains(elder.err, "holds another study: program \"0.1.0 (0123456789ab)\" instead of ")) << elder.err;
  std::ofstream(folder_.path / "killed/study.json") << ours;

  // Another study does not go on in its folder, and does not merge with it.
  const RunResult other = runIrad(study("killed", {"--set", "solver.tolerance=0.01"}));
  EXPECT_EQ(other.status, 2);
  EXPECT_TRUE(contains(other.err, "holds another study: solver.tolerance")) << other.err;
  std::string identity = file("shard2", "study.json");
  const std::string tolerance = "\"solver.tolerance\": 0.002";
  ASSERT_TRUE(contains(identity, tolerance));
  identity.replace(identity.find(tolerance), tolerance.size(), "\"solver.tolerance\": 0.01");
  std::ofstream(folder_.path / "shard2/study.json") << identity;
  const RunResult mixed = runIrad({"study", "merge", shards[0], shards[1], "--out", (folder_.path / "mixed").string()});
  EXPECT_EQ(mixed.status, 3);
  EXPECT_TRUE(contains(mixed.err, "not the study of ") && contains(mixed.err, "solver.tolerance")) << mixed.err;
}

TEST_F(StudyRuns, APointWithoutMemoryIsARow) {
  const RunResult run =
      runIrad({"study", "cost", "box", "--sweep", "voxel.resolution=1022,8", "--set", "matrix.rays=8", "--set",
               "light.shadow_resolution=64", "--seeds", "1", "--repeats", "1", "--memory-budget", "512", "--reference",
               reference_.string(), "--out", (folder_.path / "full").string()});
  EXPECT_EQ(run.status, 0) << run.err;
  const std::string points = file("full", "points.csv");
  EXPECT_TRUE(contains(points, "\n0,1022,\"pieces of voxels (facets) needs") ||
              contains(points, "\n0,1022,pieces of voxels (facets) needs"))
      << points;
  EXPECT_TRUE(contains(points, "\n1,8,done,1,")) << points;
}

TEST_F(StudyRuns, ReferencesThatDoNotFitAreRefused) {
  const RunResult size = runIrad(study("wrong", {"--size", "64x64"}));
  EXPECT_EQ(size.status, 2);
  EXPECT_TRUE(contains(size.err, ": 32 x 24 pixels, --size is 64 x 64")) << size.err;
  EXPECT_FALSE(fs::exists(folder_.path / "wrong"));
  EXPECT_EQ(runIrad({"study", "cost", "box", "--reference", (folder_.path / "none.exr").string()}).status, 3);
  EXPECT_EQ(
      runIrad({"study", "merge", (folder_.path / "none").string(), "--out", (folder_.path / "m").string()}).status, 3);
}

TEST_F(StudyRuns, ReferencesOfOtherCamerasAndViewsAreRefused) {
  if (std::string(linearExtension()) != ".exr") GTEST_SKIP() << "files of this build have no room for a camera";
  const std::string truth = (folder_.path / "truth.exr").string();
  const RunResult made =
      runIrad({"reference", "box", "--of", "matrix", "--size", "32x24", "--set", "voxel.resolution=8", "--set",
               "matrix.rays=8", "--set", "light.shadow_resolution=64", "--out", truth});
  ASSERT_EQ(made.status, 0) << made.err;
  const auto with = [&](const char* command, std::vector<std::string> more) {
    std::vector<std::string> arguments{command};
    if (command == std::string("study")) arguments.emplace_back("cost");
    arguments.insert(arguments.end(),
                     {"box", "--reference", truth, "--set", "voxel.resolution=8", "--set", "matrix.rays=8", "--set",
                      "light.shadow_resolution=64", "--size", "32x24", "--out", (folder_.path / "of").string()});
    arguments.insert(arguments.end(), more.begin(), more.end());
    return runIrad(arguments);
  };
  const std::string elsewhere =
      R"({"position": [0, 1, 2.5], "target": [0, 1, 0], "yfov": 0.7, "znear": 0.1, "name": "elsewhere"})";
  const RunResult camera = with("study", {"--camera", elsewhere});
  EXPECT_EQ(camera.status, 2);
  EXPECT_TRUE(contains(camera.err, "truth.exr: made from another camera: it stands at ")) << camera.err;
  const RunResult view = with("study", {"--view", "indirect"});
  EXPECT_EQ(view.status, 2);
  EXPECT_TRUE(contains(view.err, "truth.exr: a picture of lit, not of indirect")) << view.err;
  EXPECT_FALSE(fs::exists(folder_.path / "of"));
  const RunResult drawn = with("render", {"--camera", elsewhere, "--view", "error"});
  EXPECT_EQ(drawn.status, 2);
  EXPECT_TRUE(contains(drawn.err, "made from another camera")) << drawn.err;
  // Its own, and pictures that do not look at it.
  const RunResult own = with("study", {"--seeds", "1", "--repeats", "1"});
  EXPECT_EQ(own.status, 0) << own.err;
  EXPECT_EQ(with("render", {"--camera", elsewhere, "--view", "lit"}).status, 0);
}

TEST_F(StudyRuns, TheErrorOfFacetsFallsWithRaysAndGoesOn) {
  const auto run = [&](const char* out, const char* seeds, const char* rays = "2000") {
    std::vector<std::string> arguments{"study", "cost", "box"};
    for (const char* setting : {"voxel.resolution=8", "light.shadow_resolution=64", "solver.tolerance=0.0001"})
      arguments.insert(arguments.end(), {"--set", setting});
    arguments.insert(arguments.end(),
                     {"--sweep", "matrix.rays=8,128", "--repeats", "1", "--facet-rays", rays, "--reference",
                      reference_.string(), "--out", (folder_.path / out).string(), "--seeds", seeds});
    return runIrad(arguments);
  };
  const RunResult first = run("h", "3");
  ASSERT_EQ(first.status, 0) << first.err;
  EXPECT_TRUE(contains(first.out, "of H")) << first.out;
  const std::vector<PointSummary> points = summarize(readResults(folder_.path / "h"), {"8", "128"});
  // 16 times the rays, but not a sixteenth of the squared error: start points on large facets are few, and emitters are
  // seen by samples whose number stays.
  EXPECT_GT(points[0].hRelMse.mean / points[1].hRelMse.mean, 3);
  EXPECT_LT(points[0].hRelMse.mean / points[1].hRelMse.mean, 32);
  EXPECT_GT(points[0].hRmse.mean / points[1].hRmse.mean, 1.5);
  EXPECT_GT(points[1].hRelMse.mean, 1e-4) << "128 rays are no truth";
  EXPECT_LT(points[1].hRelMse.mean, .05) << "and nearly one: the truth is of these facets";
  size_t truths = 0;
  for ([[maybe_unused]] const auto& entry : fs::directory_iterator(folder_.path / "h/facets")) ++truths;
  EXPECT_EQ(truths, 2u) << "the facets are the same: one truth of two halves";

  // It goes on with the truth that is there, and one made anew has the same bits.
  ASSERT_EQ(run("h", "4").status, 0);
  EXPECT_EQ(readResults(folder_.path / "h").errors.size(), 8u);
  ASSERT_EQ(run("other", "4").status, 0);
  EXPECT_EQ(file("other", "errors.csv"), file("h", "errors.csv"));
  // H is part of what the study is.
  const RunResult without = run("h", "4", "3000");
  EXPECT_EQ(without.status, 2);
  EXPECT_TRUE(contains(without.err, "holds another study: facet_rays 2000 instead of 3000")) << without.err;
}

TEST_F(StudyRuns, EndAtASignalWithWholeFilesAndGoOn) {
  int runs = 0;
  const auto stopped = [&](const std::vector<std::string>& arguments, const std::function<bool()>& when) {
    const fs::path err = folder_.path / fmt::format("err{}", ++runs);
    Process process(iradProgram(), arguments, "/dev/null", err);
    for (int i = 0; i < 60'000 && !process.poll() && !when(); ++i)
      std::this_thread::sleep_for(std::chrono::milliseconds(1));
    ASSERT_FALSE(process.poll()) << slurp(err);
    ::kill(process.pid(), SIGINT);
    EXPECT_EQ(process.wait(), 1);
    EXPECT_TRUE(contains(slurp(err), "stopped by a signal; the same command goes on from here")) << slurp(err);
  };
  // Of cost, while it measures times: rows are whole, and the rest comes to the same errors.
  const std::vector<std::string> cost = study("cost", {"--repeats", "400"});
  stopped(cost, [&] {
    return fs::exists(folder_.path / "cost/errors.csv") && std::ranges::count(file("cost", "errors.csv"), '\n') > 1;
  });
  const StudyResults part = readResults(folder_.path / "cost");
  EXPECT_FALSE(fs::exists(folder_.path / "cost/report.html"));
  const RunResult rest = runIrad(study("cost", {"--repeats", "1"}));
  ASSERT_EQ(rest.status, 0) << rest.err;
  const StudyResults whole = readResults(folder_.path / "cost");
  ASSERT_EQ(whole.errors.size(), 4u);
  for (size_t i = 0; i < part.errors.size(); ++i) EXPECT_EQ(part.errors[i].relMse, whole.errors[i].relMse);

  // Of a split, while it makes its pictures.
  std::vector<std::string> split = study("split", {"--repeats", "1"});
  split[1] = "attribution";
  for (const char* option : {"--sweep", "--seeds"}) {
    const auto at = std::ranges::find(split, option);
    split.erase(at, at + 2);
  }
  const fs::path pictures = folder_.path / "split/linear";
  stopped(split, [&] { return fs::exists(pictures) && !fs::is_empty(pictures); });
  size_t made = 0;
  for (const auto& entry : fs::directory_iterator(pictures)) {
    EXPECT_EQ(readLinear(entry.path()).size, glm::uvec2(32, 24));
    ++made;
  }
  EXPECT_GT(made, 0u);
  EXPECT_FALSE(fs::exists(folder_.path / "split/attribution.csv"));

  // Of a search, in its first round; the truth that it traces is stopped between two passes.
  std::vector<std::string> tune = study("tune", {"--budget-mib", "1000", "--repeats", "400"});
  tune.erase(tune.begin(), tune.begin() + 2);
  tune.insert(tune.begin(), "tune");
  stopped(tune, [&] { return std::ranges::count(file("tune", "errors.csv"), '\n') > 1; });
  EXPECT_FALSE(readResults(folder_.path / "tune").errors.empty());
  EXPECT_FALSE(fs::exists(folder_.path / "tune/tuned.json"));
  const std::string said = slurp(folder_.path / "err3");
  EXPECT_TRUE(contains(said, "up to 6 points around the best of the grid (3 rounds)")) << said;
  // Two seeds and 400 repeats with one that warms up: of the grid, of the points around its best, of the chosen one.
  EXPECT_TRUE(contains(said, fmt::format(": {} pictures to come", 2 * (2 + 401) + 6 * (2 + 401) + 16 + 401))) << said;
  if (!hasPathTracer()) return;
  std::vector<std::string> traced = study("traced", {"--view", "indirect", "--size", "32x24"});
  const auto reference = std::ranges::find(traced, "--reference");
  *reference = "--reference-samples", *(reference + 1) = "10000000";
  stopped(traced, [&] { return contains(slurp(folder_.path / "err4"), "reference"); });
  EXPECT_FALSE(fs::exists(folder_.path / "traced/errors.csv"));
}

TEST_F(StudyRuns, ThePathTracersErrorFallsWithItsSamples) {
  if (!hasPathTracer()) GTEST_SKIP() << "this build has no path tracer (IRAD_EMBREE)";
  std::vector<std::string> arguments{"study", "cost", "box"};
  for (const char* setting : {"voxel.resolution=12", "matrix.rays=16", "light.shadow_resolution=64"})
    arguments.insert(arguments.end(), {"--set", setting});
  arguments.insert(arguments.end(), {"--seeds", "1", "--repeats", "1", "--view", "indirect", "--size", "32x24",
                                     "--reference-samples", "1024", "--peer", "path-tracer", "--peer-samples", "2,8,32",
                                     "--out", (folder_.path / "peer").string()});
  // Stopped while it traces its truth, which goes on from there.
  const fs::path err = folder_.path / "err";
  const auto filesThatEnd = [&](const char* end) {
    std::vector<fs::path> out;
    for (const auto& entry : fs::directory_iterator(folder_.path / "peer/truths"))
      if (entry.path().string().ends_with(end)) out.push_back(entry.path());
    return out;
  };
  {
    Process process(iradProgram(), arguments, "/dev/null", err);
    for (int i = 0; i < 60'000 && !process.poll() && !contains(slurp(err), "\nreference\n"); ++i)
      std::this_thread::sleep_for(std::chrono::milliseconds(1));
    ASSERT_FALSE(process.poll()) << slurp(err);
    ::kill(process.pid(), SIGINT);
    EXPECT_EQ(process.wait(), 1);
  }
  EXPECT_TRUE(contains(slurp(err),
                       "1 points, 1 seeds and 1 repeats each: 3 pictures to come; 1 truth is to be traced; "
                       "about "))
      << slurp(err);
  ASSERT_EQ(filesThatEnd(".state").size(), 1u);
  const TracedSums sums = readSums(filesThatEnd(".state")[0]).sums;
  EXPECT_TRUE(sums.samples > 0 && sums.samples < 1024) << sums.samples;
  EXPECT_TRUE(filesThatEnd(".json").empty());
  const RunResult run = runIrad(arguments);
  ASSERT_EQ(run.status, 0) << run.err;
  EXPECT_TRUE(filesThatEnd(".state").empty());
  // What was made in two runs, and read from its files, is what the tracer gives in one go.
  const Scene scene = loadScene(assets() / "box.glb");
  const TracedPicture traced =
      makePathTracer(scene)->render(scene.cameras.at(0), {32, 24}, {.samples = 1024, .seed = 1, .centred = true});
  for (const auto& [end, half] : {std::pair(".a", 0), {".b", 1}})
    EXPECT_EQ(readLinear(filesThatEnd((end + std::string(linearExtension())).c_str()).at(0)).pixels,
              pixelsOf(traced.indirect.half[half]))
        << end;
  const StudyResults results = readResults(folder_.path / "peer");
  ASSERT_EQ(results.peers.size(), 3u);
  // Unbiased and independent: a pixel's error halves with four times the samples. Of the picture's twelve blocks the
  // error is known to a factor of 2 only.
  for (size_t i = 0; i + 1 < 3; ++i) {
    EXPECT_NEAR(results.peers[i].rmse / results.peers[i + 1].rmse, 2, 0.4);
    EXPECT_GT(results.peers[i].seconds, 0);
  }
  const RunResult lit = runIrad({"study", "cost", "box", "--reference-samples", "4", "--view", "lit"});
  EXPECT_EQ(lit.status, 2);
  EXPECT_TRUE(contains(lit.err, "--view lit: the path tracer is diffuse")) << lit.err;
}

TEST_F(StudyRuns, WhatTuneChoosesHoldsForOtherSeeds) {
  if (!hasPathTracer()) GTEST_SKIP() << "this build has no path tracer (IRAD_EMBREE)";
  const Family& family = *std::ranges::find(families(), std::string_view("half-filled"), &Family::name);
  const fs::path scene = folder_.path / "half-filled.glb";
  writeGlb(scene, familyMember(family, 20, 16).scene);
  const std::string out = (folder_.path / "tune").string(), check = (folder_.path / "check").string();
  const auto with = [&](std::vector<std::string> arguments, const std::vector<std::string>& more) {
    for (const char* argument : {"--size", "48x32", "--repeats", "1", "--reference-samples", "512", "--set",
                                 "light.shadow_resolution=256", "--set", "voxel.resolution=12"})
      arguments.emplace_back(argument);
    arguments.insert(arguments.end(), more.begin(), more.end());
    return runIrad(arguments);
  };
  // By memory, which is the same on every run.
  const auto tune = [&](const char* mebibytes) {
    return with({"tune", scene.string(), "--out", out, "--seeds", "2", "--rounds", "1"},
                {"--sweep", "matrix.rays=32,256", "--budget-mib", mebibytes});
  };
  const RunResult tuned = tune("1000");
  ASSERT_EQ(tuned.status, 0) << tuned.err;
  const auto figure = [](const std::string& text, const std::string& head) {
    const size_t at = text.find(head);
    EXPECT_NE(at, std::string::npos) << head << ": " << text;
    return std::stod(text.substr(at + head.size()));
  };
  const double promised = figure(tuned.out, "error       relMSE ");
  EXPECT_TRUE(contains(tuned.out, "confidence  error: half of a 95 % interval over ")) << tuned.out;
  EXPECT_TRUE(contains(tuned.err, "up to 2 points around the best of the grid (1 round)")) << tuned.err;
  EXPECT_TRUE(contains(tuned.err, " was said")) << "how long it took, beside that: " << tuned.err;

  // The same again is read, not measured, and comes to the same.
  const std::string errors = file("tune", "errors.csv"), times = file("tune", "times.csv");
  EXPECT_EQ(tune("1000").out, tuned.out);
  EXPECT_EQ(file("tune", "errors.csv"), errors);
  EXPECT_EQ(file("tune", "times.csv"), times);

  // Other seeds, against the same truth, which is not traced again.
  for (const std::string& folder : {check, check + "2"}) {
    fs::create_directories(folder);
    fs::create_directory_symlink(folder_.path / "tune/truths", fs::path(folder) / "truths");
  }
  const RunResult held = with({"study", "cost", scene.string(), "--config", out + "/tuned.json", "--out", check},
                              {"--seeds", "64", "--seed", "500"});
  ASSERT_EQ(held.status, 0) << held.err;
  EXPECT_TRUE(contains(held.err, ": there already\n")) << held.err;
  const std::vector<PointSummary> point = summarize(readResults(check), {""});
  // Over 8 seeds half of a 95 % interval is a third of the mean, over 64 a tenth.
  EXPECT_NEAR(point.at(0).relMse.mean / promised, 1, 0.1);

  // Errors of points that were added, after times had been taken, are those of a study that begins with them.
  const StudyResults all = readResults(out);
  const SettingGrid grid(gridsOf(readIdentity(out)), Settings{});
  ASSERT_GT(grid.size(), 2u);
  const RunResult again = with({"study", "cost", scene.string(), "--out", check + "2", "--seeds", "1"},
                               {"--sweep", "matrix.rays=" + grid.values(2)[0]});
  ASSERT_EQ(again.status, 0) << again.err;
  EXPECT_EQ(readResults(check + "2").errors.at(0).relMse, std::ranges::find(all.errors, 2u, &ErrorRow::point)->relMse);

  const RunResult none = tune("0.1");
  EXPECT_EQ(none.status, 1);
  EXPECT_TRUE(contains(none.err, "irad tune: nothing is within that; the nearest is matrix.rays=")) << none.err;
}

}  // namespace
}  // namespace irad::test::study_runs_suite
