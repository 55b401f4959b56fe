// `irad study attribution` from outside: it names the stage that is made bad on purpose, for each stage in turn; a
// study that is killed goes on; bad input is refused.
#include <signal.h>

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <fstream>
#include <memory>
#include <thread>

#include "gi/check/glb.h"
#include "gi/check/path_tracer.h"
#include "gi/check/process.h"
#include "gi/check/scenes.h"
#include "renderer/base/csv.h"
#include "tests/support.h"

namespace irad::test::attribution_runs_suite {
namespace {

namespace fs = std::filesystem;
using Strings = std::vector<std::string>;

void append(Strings& to, const Strings& more) {
  to.insert(to.end(), more.begin(), more.end());
}
/// 12 voxels, 64 rays.
Strings small(const Strings& settings) {
  Strings out;
  for (const char* setting : {"voxel.resolution=12", "matrix.rays=64", "light.shadow_resolution=64"})
    append(out, {"--set", setting});
  for (const std::string& setting : settings) append(out, {"--set", setting});
  return out;
}

/// Settings that spoil one stage.
struct Spoilt {
  const char* stage;
  Strings settings;
  /// The truth: the program's own picture by these settings, so that the spoilt stage is all that differs; none: the
  /// path tracer's.
  std::optional<Strings> truth;
  const char* view = "indirect";
  Strings options;
  const char* scene = "still.glb";
  const char* size = "32x32";
};
void PrintTo(const Spoilt& spoilt, std::ostream* out) {
  *out << spoilt.stage;
}

// Without jitter all seeds have the same rays, so that what differs from the truth is what is spoilt alone.
const Spoilt kSpoilt[] = {
    {"voxels",
     {"matrix.jitter=false", "voxel.resolution=8", "matrix.rays=256"},
     Strings{"matrix.jitter=false", "voxel.resolution=24", "matrix.rays=256"},
     "indirect",
     {"--finer", "3", "--gather-rays", "256", "--seeds", "8"},
     "still.glb",
     "64x64"},
    {"facets", {"matrix.hit_rule=thesis"}, std::nullopt},
    {"normals",
     {"matrix.hit_rule=thesis", "matrix.jitter=false", "voxel.normals=axis6"},
     Strings{"matrix.hit_rule=thesis", "matrix.jitter=false"}},
    {"traversal",
     {"matrix.hit_rule=thesis", "matrix.jitter=false", "field.method=jfa", "matrix.traversal=sdf"},
     Strings{"matrix.hit_rule=thesis", "matrix.jitter=false", "matrix.traversal=dda"}},
    {"rays", {"matrix.rays=2"}, std::nullopt, "indirect", {"--seeds", "8"}},
    // Light so weak that the solver puts out most of it.
    {"storage", {"matrix.jitter=false", "solver.flush=0.001"}, std::nullopt, "indirect", {}, "dim.glb"},
    {"sweeps", {"matrix.jitter=false", "solver.max_sweeps=1", "solver.acceleration=off"}, std::nullopt},
    {"shadows", {"matrix.jitter=false"}, Strings{"matrix.jitter=false", "light.shadow_resolution=1024"}, "lit"},
    // Blocks of 8 x 8 pixels smaller than a voxel, and hardly any noise.
    {"lookup",
     {"voxel.resolution=8", "matrix.rays=1024", "sample.filter=nearest"},
     std::nullopt,
     "indirect",
     {"--finer", "1.25", "--seeds", "5", "--gather-rays", "256"},
     "still.glb",
     "64x64"},
    {"reflections",
     {"matrix.jitter=false", "specular.rays=1", "specular.filter=false"},
     Strings{"matrix.jitter=false", "specular.rays=64", "specular.max_roughness=1", "specular.fade=0",
             "specular.threshold=0", "specular.filter=false"},
     "lit"},
};

class AttributionRuns : public ::testing::Test {
 protected:
  static void SetUpTestSuite() { truths_ = std::make_unique<TemporaryFolder>(); }
  static void TearDownTestSuite() { truths_.reset(); }
  void SetUp() override {
    writeGlb(at("still.glb"), stillLife().finish("still"));
    writeGlb(at("dim.glb"), stillLife(1e-3f).finish("dim"));
  }
  std::string at(const std::string& name) const { return (folder_.path / name).string(); }
  Strings study(const Spoilt& spoilt, const std::string& out) const {
    Strings arguments{"study", "attribution", at(spoilt.scene)};
    append(arguments, small(spoilt.settings));
    append(arguments, {"--view", spoilt.view, "--size", spoilt.size, "--repeats", "1", "--out", at(out)});
    append(arguments, spoilt.options);
    const auto unlessGiven = [&](const char* option, const char* value) {
      if (std::count(spoilt.options.begin(), spoilt.options.end(), option) == 0) append(arguments, {option, value});
    };
    unlessGiven("--seeds", "3");
    unlessGiven("--gather-rays", "256");
    if (spoilt.truth) {
      append(arguments, {"--reference", reference_.string()});
    } else {
      // Studies of the same scene, size and samples have one truth: each is traced once for all tests.
      append(arguments, {"--reference-samples", "512"});
      fs::create_directories(at(out));
      if (!fs::is_symlink(at(out + "/truths"))) fs::create_directory_symlink(truths_->path, at(out + "/truths"));
    }
    return arguments;
  }
  void makeTruth(const Spoilt& spoilt) {
    if (!spoilt.truth) return;
    Strings arguments{"render", at(spoilt.scene)};
    append(arguments, small(*spoilt.truth));
    append(arguments, {"--view", spoilt.view, "--size", spoilt.size, "--out", at("truth")});
    const RunResult run = runIrad(arguments);
    ASSERT_EQ(run.status, 0) << run.err;
    for (const char* extension : {".exr", ".pfm"})
      if (const fs::path file = at(std::string("truth/") + spoilt.view + extension); fs::exists(file))
        reference_ = file;
  }
  /// A field of attribution.csv.
  std::string field(const std::string& out, const std::string& row, const std::string& column) const {
    std::ifstream in(at(out + "/attribution.csv"));
    std::string line;
    std::getline(in, line);
    const Strings head = csvFields(line);
    while (std::getline(in, line))
      if (const Strings fields = csvFields(line); fields[0] == row)
        for (size_t i = 0; i < fields.size(); ++i)
          if (head[i] == column) return fields[i];
    return "none";
  }

  TemporaryFolder folder_;
  static inline std::unique_ptr<TemporaryFolder> truths_;
  fs::path reference_;
};

class SpoiltStages : public AttributionRuns, public ::testing::WithParamInterface<Spoilt> {};

INSTANTIATE_TEST_SUITE_P(Stages, SpoiltStages, ::testing::ValuesIn(kSpoilt),
                         [](const auto& info) { return std::string(info.param.stage); });

TEST_P(SpoiltStages, AreNamed) {
  const Spoilt& spoilt = GetParam();
  if (!hasPathTracer() && !spoilt.truth) GTEST_SKIP() << "this build has no path tracer (IRAD_EMBREE)";
  makeTruth(spoilt);
  const RunResult run = runIrad(study(spoilt, "out"));
  ASSERT_EQ(run.status, 0) << run.err;
  EXPECT_TRUE(contains(run.out, std::string("The error of ") + spoilt.stage + " dominates: ")) << run.out;
  for (const char* file : {"report.html", "attribution.csv", "attribution-errors.svg", "attribution-times.svg"})
    EXPECT_TRUE(fs::exists(at(std::string("out/") + file))) << file;
  EXPECT_TRUE(contains(slurp(at("out/report.html")), spoilt.stage + std::string(" dominates")));
  EXPECT_GT(std::stod(field("out", spoilt.stage, "share")), 0.3) << run.out;
  EXPECT_NE(field("out", "picture", "mib"), "0.0000");
}

TEST_F(AttributionRuns, AKilledStudyGoesOnToTheSameFigures) {
  if (!hasPathTracer()) GTEST_SKIP() << "this build has no path tracer (IRAD_EMBREE)";
  const Spoilt plain{"", {"voxel.resolution=8"}, std::nullopt};
  const RunResult whole = runIrad(study(plain, "whole"));
  ASSERT_EQ(whole.status, 0) << whole.err;
  const auto pictures = [&] {
    std::error_code none;
    size_t count = 0;
    for (const auto& entry : fs::directory_iterator(at("killed/linear"), none))
      count += entry.path().filename().string()[0] != '.';
    return count;
  };
  bool killed = false;  // after the trial
  {
    Process process(iradProgram(), study(plain, "killed"));
    while (!killed && !process.poll()) {
      if (pictures() > 9) killed = process.kill() == 128 + SIGKILL;
      std::this_thread::sleep_for(std::chrono::milliseconds(1));
    }
  }
  EXPECT_TRUE(killed);
  EXPECT_FALSE(fs::exists(at("killed/report.html")));
  const RunResult rest = runIrad(study(plain, "killed"));
  ASSERT_EQ(rest.status, 0) << rest.err;
  EXPECT_TRUE(contains(whole.err, "\ntrial\n"));
  EXPECT_FALSE(contains(rest.err, "\ntrial\n")) << "the times of pictures that are there were lost: " << rest.err;
  // Times differ, errors do not: to the last digit.
  for (const char* row : {"picture", "model", "voxels", "rays", "rays.variance", "storage", "sweeps", "lookup", "rest"})
    for (const char* column : {"relmse", "ideal_relmse", "gain", "gain_ci95", "chain_relmse", "chain_squared"})
      EXPECT_EQ(field("whole", row, column), field("killed", row, column)) << row << " " << column;
  // Another study has no place there.
  Strings other = study(plain, "killed");
  append(other, {"--finer", "3"});
  const RunResult refused = runIrad(other);
  EXPECT_EQ(refused.status, 2);
  EXPECT_TRUE(contains(refused.err, "holds another study: study ")) << refused.err;
}

TEST_F(AttributionRuns, ASignalIsSeenWithinAPicture) {
  if (!hasPathTracer()) GTEST_SKIP() << "this build has no path tracer (IRAD_EMBREE)";
  // Its gather alone is 4 thousand million rays: minutes.
  Strings arguments = study(
      {.stage = "", .settings = {}, .truth = std::nullopt, .options = {"--gather-rays", "65536"}, .size = "256x256"},
      "stopped");
  const fs::path err = folder_.path / "err";
  Process process(iradProgram(), arguments, "/dev/null", err);
  for (int i = 0; i < 60'000 && !process.poll() && !contains(slurp(err), "\ntrial\n"); ++i)
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  std::this_thread::sleep_for(std::chrono::seconds(2));
  ASSERT_FALSE(process.poll()) << slurp(err);
  ::kill(process.pid(), SIGINT);
  const auto began = std::chrono::steady_clock::now();
  EXPECT_EQ(process.wait(), 1);
  EXPECT_LT(std::chrono::steady_clock::now() - began, std::chrono::seconds(5));
  EXPECT_TRUE(contains(slurp(err), "stopped by a signal; the same command goes on from here")) << slurp(err);
  for (const auto& entry : fs::directory_iterator(at("stopped/linear")))
    ADD_FAILURE() << entry.path() << " is not whole";
}

/// The seconds of "about 45 s", "3 min 07 s".
std::optional<double> aboutSeconds(const std::string& text) {
  const size_t at = text.find("; about ");
  int first = 0, second = 0;
  if (at == text.npos) return std::nullopt;
  const char* words = text.c_str() + at;
  if (std::sscanf(words, "; about %d min %d s", &first, &second) == 2) return 60 * first + second;
  if (std::sscanf(words, "; about %d s", &first) == 1) return first;
  return std::nullopt;
}

TEST_F(AttributionRuns, SayBeforehandHowLongTheyTake) {
  if (!hasPathTracer()) GTEST_SKIP() << "this build has no path tracer (IRAD_EMBREE)";
  // Times go to the gather and to many rays; to finer voxels.
  struct Kind {
    const char *scene, *voxels, *rays, *gather, *finer;
  };
  for (const Kind& k : {Kind{"box", "12", "64", "512", "1.5"}, Kind{"check:bent-tunnel", "12", "32", "16", "3"}}) {
    const fs::path err = folder_.path / "err";
    Process process(iradProgram(),
                    {"study",
                     "attribution",
                     k.scene,
                     "--view",
                     "indirect",
                     "--size",
                     "64x64",
                     "--seeds",
                     "4",
                     "--repeats",
                     "2",
                     "--reference-samples",
                     "64",
                     "--set",
                     std::string("voxel.resolution=") + k.voxels,
                     "--set",
                     std::string("matrix.rays=") + k.rays,
                     "--set",
                     "scene.lambertian=true",
                     "--gather-rays",
                     k.gather,
                     "--finer",
                     k.finer,
                     "--out",
                     at(std::string("out-") + k.finer)},
                    "/dev/null", err);
    while (!process.poll() && !aboutSeconds(slurp(err))) std::this_thread::sleep_for(std::chrono::milliseconds(5));
    const auto began = std::chrono::steady_clock::now();
    ASSERT_EQ(process.wait(), 0) << slurp(err);
    const double took = std::chrono::duration<double>(std::chrono::steady_clock::now() - began).count(),
                 foreseen = *aboutSeconds(slurp(err));
    printf("%s: foreseen %.0f s, took %.1f s\n", k.scene, foreseen, took);
    EXPECT_GT(foreseen + 0.5, took / 2) << k.scene;
    EXPECT_LT(foreseen - 0.5, took * 2) << k.scene;
  }
}

TEST_F(AttributionRuns, AStageWithoutMemoryIsARowThatSaysSo) {
  if (!hasPathTracer()) GTEST_SKIP() << "this build has no path tracer (IRAD_EMBREE)";
  Strings arguments = study({"", {}, std::nullopt}, "full");
  append(arguments,
         {"--finer", "8", "--set", "voxel.resolution=24", "--set", "matrix.rays=4", "--memory-budget", "24"});
  const RunResult run = runIrad(arguments);
  ASSERT_EQ(run.status, 0) << run.err;
  EXPECT_TRUE(contains(field("full", "voxels", "words"), "could not be made ideal: ")) << run.out;
  EXPECT_EQ(field("full", "voxels", "gain"), "");
}

TEST_F(AttributionRuns, OfAPointOnTheFrontOfACostStudy) {
  if (!hasPathTracer()) GTEST_SKIP() << "this build has no path tracer (IRAD_EMBREE)";
  const Strings options{"--finer", "1.25", "--gather-rays", "16"};
  Strings arguments =
      study({"", {"matrix.jitter=false"}, std::nullopt, "indirect", options, "still.glb", "16x16"}, "cost");
  arguments[1] = "cost";
  append(arguments, {"--sweep", "matrix.rays=2,64", "--split", "1"});
  const RunResult run = runIrad(arguments);
  ASSERT_EQ(run.status, 0) << run.err;
  EXPECT_TRUE(contains(run.err, ") by stage\n") && contains(run.err, " pictures to come, about ")) << run.err;
  const std::string html = slurp(at("cost/report.html"));
  EXPECT_TRUE(contains(html, "<h2>Errors beside milliseconds, by stage</h2>\n<p class=\"finding\">Point ")) << run.out;
  EXPECT_FALSE(contains(html, "Not measured: --split"));
  size_t splits = 0;
  for (const auto& entry : fs::directory_iterator(at("cost/split"))) splits += fs::exists(entry.path() / "report.html");
  EXPECT_EQ(splits, 1u);
  for (const char* plot : {"split-errors.svg", "split-times.svg"}) EXPECT_TRUE(fs::exists(at("cost/") + plot)) << plot;
}

TEST_F(AttributionRuns, BadInputIsRefused) {
  const auto refused = [&](Strings arguments, const std::string& words) {
    const RunResult run = runIrad(arguments);
    EXPECT_EQ(run.status, 2) << run.err;
    EXPECT_TRUE(contains(run.err, words)) << run.err;
  };
  refused({"study", "attribution", "box"}, "irad study attribution: no truth");
  refused({"study", "attribution", "box", "park"}, "unexpected argument 'park'");
  refused({"study", "attribution", "box", "--sweep", "matrix.rays=1,2"}, "has no --sweep");
  refused({"study", "attribution", "box", "--finer", "1"}, "--finer: '1' is not allowed");
  refused({"study", "attribution", "box", "--seeds", "2"}, "--seeds: '2' is not allowed");
  refused({"study", "attribution", "box", "--gather-rays", "0"}, "--gather-rays: '0' is not allowed");
  refused({"study", "cost", "box", "--split", "0"}, "--split: '0' is not allowed");
  refused({"study", "cost", "box", "--split", "1", "--shard", "1/2"}, "--split: a shard does not know the front");
}

}  // namespace
}  // namespace irad::test::attribution_runs_suite
