// `irad study rq10` from outside: a tiny one from end to end, one that is killed and goes on, shards that merge to the
// whole, and what is refused.
#include <fmt/format.h>
#include <signal.h>

#include <algorithm>
#include <chrono>
#include <cstdlib>
#include <thread>

#include "gi/check/path_tracer.h"
#include "gi/check/process.h"
#include "renderer/base/image_io.h"
#include "renderer/base/output_file.h"
#include "tests/support.h"

namespace irad::test::study_named_runs_suite {
namespace {

namespace fs = std::filesystem;

class NamedRuns : public ::testing::Test {
 protected:
  void SetUp() override {
    if (!hasPathTracer()) GTEST_SKIP() << "this build has no path tracer (IRAD_EMBREE)";
    ::setenv("IRAD_SHARED", (folder_.path / "none").c_str(), 1);  // no Sponza
  }
  void TearDown() override { ::unsetenv("IRAD_SHARED"); }
  std::vector<std::string> study(const std::string& out, const std::vector<std::string>& more = {},
                                 const char* name = "rq10") const {
    std::vector<std::string> arguments{"study", name};
    for (const char* setting : {"voxel.resolution=8", "matrix.rays=8", "light.shadow_resolution=64"})
      arguments.insert(arguments.end(), {"--set", setting});
    for (const char* option :
         {"--scale", "small", "--size", "16x16", "--seeds", "2", "--repeats", "1", "--reference-samples", "8"})
      arguments.emplace_back(option);
    arguments.insert(arguments.end(), {"--out", (folder_.path / out).string()});
    arguments.insert(arguments.end(), more.begin(), more.end());
    return arguments;
  }
  std::string file(const std::string& out, const std::string& name) const { return slurp(folder_.path / out / name); }

  TemporaryFolder folder_;
};

TEST_F(NamedRuns, AKilledOneGoesOnAndShardsMergeToTheSame) {
  const RunResult whole = runIrad(study("whole"));
  ASSERT_EQ(whole.status, 0) << whole.err;
  EXPECT_TRUE(contains(whole.err, "scale small: as asked for")) << whole.err;
  EXPECT_TRUE(contains(whole.err, "2 of 3: rq10 curved-thesis, ") && contains(whole.err, " left")) << whole.err;
  EXPECT_TRUE(contains(whole.out, "rq10: What does blurring what is sampled do?")) << whole.out;
  EXPECT_TRUE(contains(whole.out, "skipped: no Sponza (--sponza FILE)")) << whole.out;
  EXPECT_TRUE(contains(whole.out, "    here: FLIP, box-thesis: linear ")) << whole.out;
  const std::string html = file("whole", "report.html");
  EXPECT_TRUE(html.ends_with("</html>\n"));
  EXPECT_TRUE(contains(html, "Skipped: no Sponza"));
  if (fs::exists(folder_.path / "whole/box-thesis/pictures/reference.png")) {
    size_t pictures = 0;
    for (size_t at = 0; (at = html.find("href=\"data:image/png;base64,iVBORw0KGgo", at)) != std::string::npos; ++at)
      ++pictures;
    EXPECT_EQ(pictures, 10u) << "the truth and four points, twice";
  }
  for (const char* name :
       {"findings.csv", "box-thesis/errors.csv", "box-thesis/report.html", "curved-thesis/figures.csv"})
    EXPECT_TRUE(fs::exists(folder_.path / "whole" / name)) << name;

  const auto rows = [&](const std::string& out) {
    const std::string text = file(out, "box-thesis/errors.csv");
    return std::ranges::count(text, '\n');
  };
  bool killed = false;
  {
    Process process(iradProgram(), study("killed"));
    while (!killed && !process.poll()) {
      if (rows("killed") > 2) killed = process.kill() == 128 + SIGKILL;
      std::this_thread::sleep_for(std::chrono::milliseconds(1));
    }
  }
  EXPECT_TRUE(killed);
  EXPECT_FALSE(fs::exists(folder_.path / "killed/report.html"));
  EXPECT_TRUE(file("whole", "box-thesis/errors.csv").starts_with(file("killed", "box-thesis/errors.csv")));
  ASSERT_EQ(runIrad(study("killed")).status, 0);

  for (const char* shard : {"1/2", "2/2"})
    ASSERT_EQ(runIrad(study(std::string("shard") + shard[0], {"--shard", shard})).status, 0);
  EXPECT_LT(rows("shard1"), rows("whole"));
  const RunResult merged = runIrad({"study", "merge", (folder_.path / "shard1").string(),
                                    (folder_.path / "shard2").string(), "--out", (folder_.path / "merged").string()});
  ASSERT_EQ(merged.status, 0) << merged.err;
  for (const char* out : {"killed", "merged"})
    for (const char* experiment : {"box-thesis", "curved-thesis"})
      for (const char* name : {"errors.csv", "figures.csv"})
        EXPECT_EQ(file(out, fmt::format("{}/{}", experiment, name)),
                  file("whole", fmt::format("{}/{}", experiment, name)))
            << out << " " << experiment << " " << name;
  EXPECT_EQ(file("merged", "findings.csv"), file("whole", "findings.csv")) << "relMSE and light alone are in them";

  // What was merged can be gone on with: the shards' truths came along.
  const RunResult goesOn = runIrad(study("merged"));
  EXPECT_EQ(goesOn.status, 0) << goesOn.err;
  EXPECT_TRUE(contains(goesOn.err,
                       "8 points: 0 pictures to come; 2 of them compute a truth, of which 2 are different "
                       "and 0 are to be made\n"))
      << goesOn.err;

  // Another scale in its folder, and shards of another study.
  const RunResult other = runIrad({"study", "rq11", "--scale", "small", "--out", (folder_.path / "whole").string()});
  EXPECT_EQ(other.status, 2);
  EXPECT_TRUE(contains(other.err, "holds another study: rq10 (small, ")) << other.err;
  const RunResult mixed = runIrad({"study", "merge", (folder_.path / "shard1").string(),
                                   (folder_.path / "none").string(), "--out", (folder_.path / "m").string()});
  EXPECT_EQ(mixed.status, 3) << mixed.err;
}

// rq7's two experiments from the Box's camera `main` and its two from `close` ask for one truth each; of its third
// shard of four each has one point.
TEST_F(NamedRuns, ExperimentsShareTheTruthsThatTheyNeed) {
  const auto rq7 = [&](const std::string& out, std::vector<std::string> more = {}) {
    if (more.empty()) more = {"--shard", "3/4"};
    return runIrad(study(out, more, "rq7"));
  };
  const RunResult first = rq7("all");
  ASSERT_EQ(first.status, 0) << first.err;
  EXPECT_TRUE(contains(first.err,
                       "4 experiments, 4 points: 16 pictures to come; 4 of them compute a truth, of which 2 "
                       "are different and 2 are to be made; about "))
      << first.err;
  const auto truths = [&](const std::string& out) {
    std::vector<std::string> names;
    for (const auto& entry : fs::directory_iterator(folder_.path / out / "truths"))
      names.push_back(entry.path().filename().string());
    std::ranges::sort(names);
    return names;
  };
  const std::vector<std::string> files = truths("all");
  ASSERT_EQ(files.size(), 6u) << "of each two halves and what vouches for them";
  const std::string close = files[0].substr(0, files[0].find('.')), main = files[3].substr(0, files[3].find('.'));
  EXPECT_TRUE(close.starts_with("box-close-indirect-") && main.starts_with("box-main-indirect-")) << close << main;
  for (const std::string& line :
       {"truth " + main + ": is made\n", "truth " + close + ": is made\n",
        "truth " + main + ": shared with rq7 box-thesis\n", "truth " + close + ": shared with rq7 curved-thesis\n"})
    EXPECT_TRUE(contains(first.err, line) && first.err.find(line) == first.err.rfind(line)) << line << first.err;
  // Reports need nothing of it.
  const std::string report = file("all", "curved-ours/report.html");
  EXPECT_TRUE(contains(report, "</html>") && !contains(report, "truths/"));
  EXPECT_EQ(file("all", "curved-ours/pictures/reference.png"), file("all", "curved-thesis/pictures/reference.png"));

  // A thesis's folder takes its questions one by one; what is there is not measured again.
  fs::create_directories(folder_.path / "thesis/rq7");
  std::string named = file("all", "named.json");
  named.replace(named.find("rq7"), 3, "thesis");
  writeFile(folder_.path / "thesis/named.json", named);
  fs::rename(folder_.path / "all/truths", folder_.path / "thesis/truths");
  for (const char* experiment : {"box-thesis", "curved-thesis", "voxels-thesis"})
    fs::rename(folder_.path / "all" / experiment, folder_.path / "thesis/rq7" / experiment);
  // A picture that nothing vouches for is not taken, though it is whole: that of the other camera.
  fs::copy_file(folder_.path / "thesis/truths" / files[3], folder_.path / "thesis/truths" / files[0],
                fs::copy_options::overwrite_existing);
  const RunResult again = rq7("thesis");
  ASSERT_EQ(again.status, 0) << again.err;
  EXPECT_TRUE(contains(again.err, ": 4 pictures to come; 4 of them compute a truth, of which 2 are different and 1 "))
      << again.err;
  EXPECT_TRUE(contains(again.err, "truth " + main + ": there already\n")) << again.err;
  EXPECT_TRUE(contains(again.err, files[0] + ": not the picture that was written; it is made anew")) << again.err;
  EXPECT_TRUE(contains(again.out, "rq7: What changes") && !contains(again.out, "rq8: ")) << again.out;
  EXPECT_EQ(truths("thesis"), files);
  for (const char* name : {"errors.csv", "figures.csv"})
    EXPECT_EQ(file("thesis", fmt::format("rq7/curved-ours/{}", name)),
              file("all", fmt::format("curved-ours/{}", name)));
  EXPECT_TRUE(file("thesis", "report.html").ends_with("</html>\n"));

  // Other lights: neither that study nor its truths. Of a shard beyond all points there is nothing.
  const RunResult other =
      rq7("thesis", {"--shard", "3/4", "--lights", R"([{"type": "sun", "direction": [0, -1, 0]}])"});
  EXPECT_EQ(other.status, 2);
  EXPECT_TRUE(contains(other.err, "holds another study: scene_as_loaded ")) << other.err;
  const RunResult beyond = rq7("beyond", {"--shard", "5/5"});
  ASSERT_EQ(beyond.status, 0) << beyond.err;
  EXPECT_TRUE(contains(beyond.err, "0 experiments, 0 points: 0 pictures to come")) << beyond.err;
  EXPECT_FALSE(fs::exists(folder_.path / "beyond/truths"));
}

TEST_F(NamedRuns, EndAtASignalWithWholeFilesAndGoOn) {
  {
    Process process(iradProgram(), study("stopped"), "/dev/null", folder_.path / "err");
    for (int i = 0; i < 20'000 && !process.poll(); ++i) {
      if (contains(file("stopped", "box-thesis/errors.csv"), "\n0,1,")) break;
      std::this_thread::sleep_for(std::chrono::milliseconds(1));
    }
    ASSERT_FALSE(process.poll());
    ::kill(process.pid(), SIGINT);
    EXPECT_EQ(process.wait(), 1);
    const std::string err = slurp(folder_.path / "err");
    EXPECT_TRUE(contains(err, "stopped by a signal; the same command goes on from here")) << err;
  }
  const RunResult rest = runIrad(study("stopped"));
  EXPECT_EQ(rest.status, 0) << rest.err;
}

TEST_F(NamedRuns, WithoutPicturesByCyclesAreSkippedInWords) {
  if (std::system("command -v blender > /dev/null 2>&1") == 0) GTEST_SKIP() << "Blender is installed";
  const RunResult run = runIrad({"study", "rq1", "--scale", "small", "--out", (folder_.path / "rq1").string()});
  EXPECT_EQ(run.status, 0) << run.err;
  EXPECT_TRUE(contains(run.out, "skipped: Blender is not installed")) << run.out;
  EXPECT_TRUE(contains(run.out, "Not measured: ") && contains(run.out, "\n    open\n")) << run.out;
}

/// A program in Blender's place that writes the same grey into every pass, and fails for EEVEE.
TEST_F(NamedRuns, AskBlenderWhereItIs) {
  const fs::path shared = folder_.path / "none", bin = folder_.path / "bin", pass = folder_.path / "pass.pfm";
  fs::create_directories(shared / "tools");
  fs::create_directories(bin);
  writeFile(shared / "tools/cycles_reference.py", "the stand-in does not read it\n");
  writePfm(pass, {16, 16}, std::vector<glm::vec4>(256, glm::vec4(.5f, .5f, .5f, 1)));
  writeFile(
      bin / "blender",
      "#!/bin/sh\nwhile [ $# -gt 0 ]; do\n  [ \"$1\" = --out ] && out=$2\n  [ \"$1\" = EEVEE ] && exit 3\n  shift\n"
      "done\nfor part in combined diffdir diffind diffcol glossdir glossind glosscol emit; do\n  cp " +
          pass.string() + " \"${out}_$part.pfm\"\ndone\n");
  fs::permissions(bin / "blender", fs::perms::owner_all);
  const std::string path = std::getenv("PATH");
  ::setenv("PATH", (bin.string() + ":" + path).c_str(), 1);
  const RunResult run = runIrad({"study", "rq1", "--scale", "small", "--size", "16x16", "--seeds", "2", "--repeats",
                                 "1", "--set", "voxel.resolution=8", "--set", "matrix.rays=8", "--set",
                                 "light.shadow_resolution=64", "--out", (folder_.path / "rq1").string()});
  ::setenv("PATH", path.c_str(), 1);
  ASSERT_EQ(run.status, 0) << run.err;
  EXPECT_TRUE(contains(file("rq1", "box-cycles-lit/figures.csv"), "truth_mean,0.5\n"));
  EXPECT_TRUE(contains(file("rq1", "park-cycles-indirect/figures.csv"), "truth_mean,0.25\n")) << "light times colour";
  EXPECT_TRUE(contains(file("rq1", "park-cycles-direct/figures.csv"), "truth_mean,1\n"))
      << "diffuse light times colour, glossy light times colour, and what is emitted";
  EXPECT_TRUE(contains(run.out, "box-cycles-specular: mean radiance ")) << run.out;
  EXPECT_TRUE(contains(run.out, "box-eevee-lit skipped: blender ended with status 3: see ")) << run.out;
}

TEST_F(NamedRuns, RefuseWhatDoesNotGoTogether) {
  const auto refused = [&](std::vector<std::string> arguments, int status, const std::string& words) {
    arguments.insert(arguments.begin(), "study");
    const RunResult run = runIrad(arguments);
    EXPECT_EQ(run.status, status) << run.err;
    EXPECT_TRUE(contains(run.err, words)) << run.err;
  };
  refused({"rq13"}, 2, "unknown study 'rq13' (did you mean rq1");
  refused({"thesys"}, 2, "unknown study 'thesys' (did you mean thesis");
  refused({"rq4", "--scale", "smal"}, 2, "--scale: unknown 'smal' (did you mean small?)");
  refused({"rq4", "--shard", "3/2"}, 2, "--shard: '3/2': the part is not 1 to 2");
  refused({"rq4", "--sweep", "matrix.rays=1,2"}, 2, "irad study rq4: --sweep is the experiments' own");
  refused({"rq4", "--sponza", (folder_.path / "none.glb").string()}, 3, "none.glb: no such file");
  refused({"rq4", "box"}, 2, "irad study rq4: unexpected argument 'box'");
  const RunResult help = runIrad({"study", "--help"});
  EXPECT_EQ(help.status, 0);
  EXPECT_TRUE(contains(help.out, "rq12: What does writing reflections back do?")) << help.out;
}

}  // namespace
}  // namespace irad::test::study_named_runs_suite
