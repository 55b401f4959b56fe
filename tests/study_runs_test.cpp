// `irad study` from outside: a study that is killed goes on, shards merge to the whole, points without memory are rows,
// and references that do not fit are refused.
#include <signal.h>

#include <algorithm>
#include <chrono>
#include <fstream>
#include <sstream>
#include <thread>

#include "gi/check/path_tracer.h"
#include "gi/check/process.h"
#include "gi/study/results.h"
#include "tests/support.h"

namespace irad::test::study_runs_suite {
namespace {

namespace fs = std::filesystem;

class StudyRuns : public ::testing::Test {
 protected:
  /// A picture of the program's own as reference: rendered with more voxels and rays.
  void SetUp() override {
    const RunResult run =
        runIrad({"render", "box", "--size", "32x24", "--set", "voxel.resolution=20", "--set", "matrix.rays=64", "--set",
                 "light.shadow_resolution=64", "--out", (folder_.path / "truth").string()});
    ASSERT_EQ(run.status, 0) << run.err;
    for (const char* name : {"lit.exr", "lit.pfm"})
      if (fs::exists(folder_.path / "truth" / name)) reference_ = folder_.path / "truth" / name;
  }
  std::vector<std::string> study(const std::string& out, const std::vector<std::string>& more = {}) const {
    std::vector<std::string> arguments{"study",
                                       "cost",
                                       "box",
                                       "--sweep",
                                       "voxel.resolution=8,12",
                                       "--sweep",
                                       "matrix.rays=8..16*2",
                                       "--set",
                                       "light.shadow_resolution=64",
                                       "--seeds",
                                       "2",
                                       "--repeats",
                                       "2",
                                       "--reference",
                                       reference_.string(),
                                       "--out",
                                       (folder_.path / out).string()};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return arguments;
  }
  std::string file(const std::string& out, const std::string& name) const { return slurp(folder_.path / out / name); }

  TemporaryFolder folder_;
  fs::path reference_;
};

TEST_F(StudyRuns, AKilledStudyGoesOnAndShardsMergeToTheSameErrors) {
  const RunResult whole = runIrad(study("whole"));
  ASSERT_EQ(whole.status, 0) << whole.err;
  EXPECT_TRUE(contains(whole.out, "Build: ")) << whole.out;
  const StudyResults results = readResults(folder_.path / "whole");
  ASSERT_EQ(results.errors.size(), 8u);
  for (size_t point = 0; point < 4; ++point) {
    EXPECT_TRUE(results.hasTimes(point, 1));
    EXPECT_FALSE(results.hasTimes(point, 2));
  }
  for (const ErrorRow& r : results.errors) {
    EXPECT_GT(r.relMse, 0);
    EXPECT_GT(r.facets, 0u);
    EXPECT_GT(r.deviceMib, r.matrixMib);
  }
  for (const char* name : {"report.html", "points.csv", "stages.csv", "error-against-build.svg"})
    EXPECT_TRUE(fs::exists(folder_.path / "whole" / name)) << name;

  // Killed when some errors are there, and again among the times.
  const auto rows = [&](const char* name) {
    const std::string text = file("killed", name);
    return std::ranges::count(text, '\n');
  };
  const auto killWhen = [&](const char* name, long least) {
    Process process(iradProgram(), study("killed"));
    while (!process.poll()) {
      if (rows(name) > least) return process.kill() == 128 + SIGKILL;
      std::this_thread::sleep_for(std::chrono::milliseconds(1));
    }
    return false;
  };
  EXPECT_TRUE(killWhen("errors.csv", 2));
  const std::string before = file("killed", "errors.csv");
  EXPECT_LT(rows("errors.csv"), 9) << "killed too late to show anything";
  EXPECT_TRUE(file("whole", "errors.csv").starts_with(before)) << "what is there is whole";
  const RunResult rest = runIrad(study("killed"));
  ASSERT_EQ(rest.status, 0) << rest.err;
  EXPECT_EQ(file("killed", "errors.csv"), file("whole", "errors.csv")) << "the same to the last digit";

  // What is done is not done again: the times of a third run are those of the second.
  const std::string times = file("killed", "times.csv");
  ASSERT_EQ(runIrad(study("killed")).status, 0);
  EXPECT_EQ(file("killed", "times.csv"), times);

  for (const char* shard : {"1/2", "2/2"})
    ASSERT_EQ(runIrad(study(std::string("shard") + shard[0], {"--shard", shard})).status, 0);
  EXPECT_NE(file("shard1", "errors.csv"), file("whole", "errors.csv"));
  const RunResult merged = runIrad({"study", "merge", (folder_.path / "shard1").string(),
                                    (folder_.path / "shard2").string(), "--out", (folder_.path / "merged").string()});
  ASSERT_EQ(merged.status, 0) << merged.err;
  EXPECT_EQ(file("merged", "errors.csv"), file("whole", "errors.csv"));
  EXPECT_TRUE(contains(file("merged", "report.html"), "Where the milliseconds go"));

  // Another study does not go on in its folder, and does not merge with it.
  const RunResult other = runIrad(study("killed", {"--set", "solver.tolerance=0.01"}));
  EXPECT_EQ(other.status, 2);
  EXPECT_TRUE(contains(other.err, "holds another study: solver.tolerance")) << other.err;
  ASSERT_EQ(runIrad(study("other", {"--shard", "2/2", "--set", "solver.tolerance=0.01"})).status, 0);
  const RunResult mixed = runIrad({"study", "merge", (folder_.path / "shard1").string(),
                                   (folder_.path / "other").string(), "--out", (folder_.path / "mixed").string()});
  EXPECT_EQ(mixed.status, 3);
  EXPECT_TRUE(contains(mixed.err, "solver.tolerance")) << mixed.err;
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

TEST_F(StudyRuns, ThePathTracersErrorFallsWithItsSamples) {
  if (!hasPathTracer()) GTEST_SKIP() << "this build has no path tracer (IRAD_EMBREE)";
  const RunResult run = runIrad({"study",
                                 "cost",
                                 "box",
                                 "--set",
                                 "voxel.resolution=12",
                                 "--set",
                                 "matrix.rays=16",
                                 "--set",
                                 "light.shadow_resolution=64",
                                 "--seeds",
                                 "1",
                                 "--repeats",
                                 "1",
                                 "--view",
                                 "indirect",
                                 "--size",
                                 "32x24",
                                 "--reference-samples",
                                 "1024",
                                 "--peer",
                                 "path-tracer",
                                 "--peer-samples",
                                 "2,8,32",
                                 "--out",
                                 (folder_.path / "peer").string()});
  ASSERT_EQ(run.status, 0) << run.err;
  const StudyResults results = readResults(folder_.path / "peer");
  ASSERT_EQ(results.peers.size(), 3u);
  // Unbiased and independent: the error falls as 1/n, a factor of 4 each time.
  for (size_t i = 0; i + 1 < 3; ++i) {
    EXPECT_LT(results.peers[i + 1].relMse, results.peers[i].relMse / 2);
    EXPECT_GT(results.peers[i].seconds, 0);
  }
  const RunResult lit = runIrad({"study", "cost", "box", "--reference-samples", "4"});
  EXPECT_EQ(lit.status, 2);
  EXPECT_TRUE(contains(lit.err, "--view lit: the path tracer is diffuse")) << lit.err;
}

}  // namespace
}  // namespace irad::test::study_runs_suite
