// The irad program under faults, from outside: no memory, a lost device, a full disk, a folder that may not be written,
// a kill in the middle, files of newer programs. Exit statuses as in docs/conventions.md, errors in words, nothing
// half-written.
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <signal.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <fstream>
#include <functional>
#include <map>
#include <nlohmann/json.hpp>
#include <random>
#include <thread>

#include "gi/check/path_state.h"
#include "gi/check/process.h"
#include "renderer/base/error.h"
#include "renderer/base/image_io.h"
#include "renderer/scene/scene.h"
#include "tests/support.h"

namespace irad::test::program_faults_suite {
namespace {

namespace fs = std::filesystem;

bool isTemporary(const std::string& name) {
  return name.starts_with(".") && name.ends_with(".irad-tmp");
}

std::vector<std::string> smallExport(const fs::path& out) {
  return {"export",   "box",
          "--out",    out.string(),
          "--volume", "all",
          "--matrix", "--facets",
          "--set",    "voxel.resolution=24",
          "--set",    "matrix.rays=16",
          "--set",    "light.shadow_resolution=64"};
}

/// Every file under a final name has the bytes that an undisturbed run gives it; a manifest vouches for all of them.
void expectWhole(const std::map<std::string, std::string>& files, const std::map<std::string, std::string>& reference) {
  for (const auto& [name, bytes] : files) {
    if (isTemporary(name)) continue;
    ASSERT_TRUE(reference.contains(name)) << name;
    EXPECT_TRUE(name == "timings.csv" || bytes == reference.at(name)) << name << " is not whole";
  }
  if (!files.contains("manifest.json")) return;
  for (const auto& name : nlohmann::json::parse(files.at("manifest.json"))["files"])
    EXPECT_TRUE(files.contains(name)) << name;
}

TEST(ProgramFaults, NoMemoryIsStatus4AndALostDeviceStatus1) {
  TemporaryFolder folder;
  const fs::path whole = folder.path / "whole";
  const auto render = [](const fs::path& out, const std::vector<std::string>& more = {}) {
    std::vector<std::string> arguments = quickRender(out);
    arguments.insert(arguments.end(), {"--frames", "50"});
    arguments.insert(arguments.end(), more.begin(), more.end());
    return arguments;
  };
  ASSERT_EQ(startIrad(render(whole)).status, 0);
  const auto reference = contents(whole);
  struct Case {
    std::string fault;
    int status;
    std::string message;
  };
  // In the load, in the building, and (of 100 frames) in those of the second picture.
  const std::vector<Case> cases{{"oom=1", 4, "(scene) needs"},          {"oom=60", 4, ") needs "},
                                {"lost=1", 1, "the device was lost"},   {"lost=60", 1, "the device was lost"},
                                {"lost=360", 1, "the device was lost"}, {"oom=100000", 0, ""}};
  for (const Case& c : cases) {
    const fs::path out = folder.path / c.fault;
    const RunResult result = startIrad(render(out, {"--inject", c.fault, "--validate"}), 120);
    EXPECT_EQ(result.status, c.status) << c.fault << "\n" << result.err;
    EXPECT_TRUE(contains(result.err, c.message)) << result.err;
    const size_t first = result.err.find("irad: ");
    EXPECT_EQ(first != std::string::npos, c.status != 0) << result.err;
    EXPECT_EQ(first, result.err.rfind("irad: ")) << "said more than once:\n" << result.err;
    const auto files = contents(out);
    expectWhole(files, reference);
    EXPECT_EQ(files.contains("manifest.json"), c.status == 0) << c.fault;
    EXPECT_EQ(files.empty(), c.status != 0 && c.fault != "lost=360") << c.fault;
    EXPECT_TRUE(std::none_of(files.begin(), files.end(), [](const auto& f) { return isTemporary(f.first); }))
        << c.fault;
  }
}

TEST(ProgramFaults, ABudgetIsAnOption) {
  TemporaryFolder folder;
  const RunResult tight = runIrad(smallRender(folder.path, {"--memory-budget", "1"}));
  EXPECT_EQ(tight.status, 4) << tight.err;
  EXPECT_TRUE(contains(tight.err, " of 1.0 MiB are free")) << tight.err;
  const RunResult padded = runIrad(smallRender(
      folder.path, {"--memory-budget", "5", "--set", "voxel.resolution=24", "--set", "matrix.hit_rule=thesis", "--set",
                    "matrix.format=padded", "--set", "matrix.rays=512"}));
  EXPECT_EQ(padded.status, 4) << padded.err;
  EXPECT_TRUE(contains(padded.err, "the padded matrix of ")) << padded.err;
  EXPECT_TRUE(contains(padded.err, "matrix.format=csr")) << padded.err;
  const RunResult huge =
      runIrad(smallRender(folder.path, {"--memory-budget", "512", "--set", "voxel.resolution=1022"}));
  EXPECT_EQ(huge.status, 4) << huge.err;
  EXPECT_TRUE(contains(huge.err, "pieces of voxels (facets) needs 4096.0 MiB, 5")) << huge.err;
  EXPECT_EQ(runIrad(smallRender(folder.path, {"--memory-budget", "64"})).status, 0);
  for (const std::vector<std::string>& wrong : std::vector<std::vector<std::string>>{{"--memory-budget", "0"},
                                                                                     {"--memory-budget", "much"},
                                                                                     {"--inject", "oom"},
                                                                                     {"--inject", "oom=0"},
                                                                                     {"--inject", "fire=1"}})
    EXPECT_EQ(runIrad(smallRender(folder.path, wrong)).status, 2) << wrong[0] << " " << wrong[1];
}

/// A disk of so many KiB, mounted for one run; the folder's contents when it ended.
struct SmallDisk {
  RunResult result;
  std::map<std::string, std::string> files;
};
SmallDisk runOnSmallDisk(const fs::path& folder, int kib, std::vector<std::string> arguments) {
  const fs::path disk = folder / "disk", copy = folder / fmt::format("copy{}", kib);
  fs::create_directories(disk);
  // The mount is this process tree's own and goes with it; what came to lie on it is copied out before.
  const std::string script = fmt::format(
      "mount -t tmpfs -o size={}k none \"$1\" || exit 99; copy=$2; disk=$1; shift 2; \"$@\"; status=$?; "
      "cp -r \"$disk/out\" \"$copy\" 2>/dev/null; exit $status",
      kib);
  std::vector<std::string> words{"-m", "sh", "-c", script, "sh", disk.string(), copy.string(), iradProgram()};
  words.insert(words.end(), arguments.begin(), arguments.end());
  SmallDisk run{runProgram("/usr/bin/unshare", words, 120), {}};
  run.files = contents(copy);
  return run;
}

using Arguments = std::function<std::vector<std::string>(const fs::path&)>;

void fillDisks(const Arguments& arguments) {
  TemporaryFolder folder;
  int full = 0;
  const fs::path whole = folder.path / "whole";
  ASSERT_EQ(runIrad(arguments(whole)).status, 0);
  const auto reference = contents(whole);
  uint64_t bytes = 0;
  for (const auto& [name, content] : reference) bytes += content.size();
  for (const double share : {0.05, 0.4, 0.8, 1.5}) {
    const int kib = std::max(4, static_cast<int>(share * static_cast<double>(bytes) / 1024));
    const SmallDisk run = runOnSmallDisk(folder.path, kib, arguments(folder.path / "disk" / "out"));
    if (run.result.status == 99 || contains(run.result.err, "unshare failed"))
      GTEST_SKIP() << "no small disk can be mounted here: " << run.result.err;
    EXPECT_EQ(run.result.status, share < 1 ? 1 : 0) << kib << " KiB\n" << run.result.err;
    if (share < 1) {
      ++full;
      EXPECT_TRUE(contains(run.result.err, "No space left on device")) << run.result.err;
      EXPECT_TRUE(contains(run.result.err, (folder.path / "disk" / "out").string())) << run.result.err;
    }
    EXPECT_EQ(run.files.contains("manifest.json"), share > 1) << kib << " KiB";
    expectWhole(run.files, reference);
    for (const auto& [name, content] : run.files) EXPECT_FALSE(isTemporary(name)) << name;
    fs::remove_all(folder.path / fmt::format("copy{}", kib));
  }
  EXPECT_EQ(full, 3);
}

TEST(ProgramFaults, AFullDiskIsStatus1AndLeavesWholePicturesOnly) {
  fillDisks(quickRender);
}

TEST(ProgramFaults, AFullDiskIsStatus1AndLeavesWholeArraysOnly) {
  fillDisks(smallExport);
}

TEST(ProgramFaults, AFullDiskLeavesOfAReferenceWhatARunGoesOnFrom) {
  if (!hasPathTracer()) GTEST_SKIP() << "this build has no path tracer (IRAD_EMBREE)";
  TemporaryFolder folder;
  const auto arguments = [](const fs::path& out) {
    return std::vector<std::string>{
        "reference", "box",   "--of", "triangles", "--size",
        "64x64",     "--spp", "4",    "--out",     (out / "ref").string() + linearExtension()};
  };
  const uint64_t stateKib = 64 * 64 * 144 / 1024;
  for (const uint64_t kib : {stateKib / 2, stateKib + 16}) {
    const SmallDisk run = runOnSmallDisk(folder.path, static_cast<int>(kib), arguments(folder.path / "disk" / "out"));
    if (run.result.status == 99 || contains(run.result.err, "unshare failed"))
      GTEST_SKIP() << "no small disk can be mounted here: " << run.result.err;
    EXPECT_EQ(run.result.status, 1) << run.result.err;
    EXPECT_TRUE(contains(run.result.err, "No space left on device")) << run.result.err;
    EXPECT_FALSE(run.files.contains("ref.json"));
    EXPECT_FALSE(run.files.contains(std::string("ref") + linearExtension()));
    EXPECT_EQ(run.files.contains("ref.state"), kib > stateKib);
    for (const auto& [name, content] : run.files) EXPECT_FALSE(isTemporary(name)) << name;
  }
  const fs::path state = folder.path / fmt::format("copy{}", stateKib + 16) / "ref.state";
  EXPECT_EQ(readSums(state).sums.samples, 4u);
}

TEST(ProgramFaults, AFileSizeLimitIsStatus1) {
  TemporaryFolder folder;
  std::vector<std::string> words{"--fsize=20000", iradProgram()};
  const auto arguments = smallExport(folder.path / "out");
  words.insert(words.end(), arguments.begin(), arguments.end());
  const RunResult result = runProgram("/usr/bin/prlimit", words, 120);
  EXPECT_EQ(result.status, 1) << result.err;
  EXPECT_TRUE(contains(result.err, "File too large")) << result.err;
  EXPECT_TRUE(contents(folder.path / "out").empty());
}

TEST(ProgramFaults, AFolderThatMayNotBeWrittenIsStatus1) {
  TemporaryFolder folder;
  fs::permissions(folder.path, fs::perms(0755));
  const fs::path locked = folder.path / "locked";
  fs::create_directory(locked);
  fs::permissions(locked, fs::perms(0555));
  // The superuser may write anywhere, so the process becomes nobody first.
  const bool root = geteuid() == 0;
  const auto run = [&](const std::vector<std::string>& arguments) {
    std::vector<std::string> words{"--reuid=65534", "--regid=65534", "--clear-groups", iradProgram()};
    words.insert(words.end(), arguments.begin(), arguments.end());
    return root ? runProgram("/usr/bin/setpriv", words, 120) : startIrad(arguments, 120);
  };
  if (run({"--version"}).status != 0) GTEST_SKIP() << "another user cannot run " << iradProgram();
  for (const auto& arguments : {smallRender(locked), smallExport(locked), smallRender(locked / "sub")}) {
    const RunResult result = run(arguments);
    EXPECT_EQ(result.status, 1) << result.err;
    EXPECT_TRUE(contains(result.err, locked.string())) << result.err;
    EXPECT_TRUE(contains(result.err, "Permission denied")) << result.err;
  }
  EXPECT_TRUE(contents(locked).empty());
}

/// Starts the program, and kills it with SIGKILL as soon as `now` holds; false: it ended before.
bool killWhen(const std::vector<std::string>& arguments, const std::function<bool()>& now) {
  Process process(iradProgram(), arguments);
  while (!process.poll()) {
    if (now()) return process.kill() == 128 + SIGKILL;
    std::this_thread::sleep_for(std::chrono::microseconds(200));
  }
  return false;
}

/// Killed once k files have their final names and a random moment has passed, for k = 0, step, 2 step...; the next run
/// finds what is left.
void killThroughout(size_t step, const Arguments& arguments) {
  TemporaryFolder folder;
  const fs::path whole = folder.path / "whole", out = folder.path / "out";
  ASSERT_EQ(runIrad(arguments(whole)).status, 0);
  const auto reference = contents(whole);
  fs::create_directory(out);
  std::mt19937 random(1);
  size_t leftovers = 0, killed = 0;
  size_t runs = 0;
  for (size_t k = 0; k < reference.size(); k += step, ++runs) {
    for (const auto& [name, bytes] : reference) fs::remove(out / name);
    const bool hit = killWhen(arguments(out), [&] {
      size_t finals = 0, all = 0;
      for (const auto& entry : fs::directory_iterator(out)) {
        ++all;
        finals += !isTemporary(entry.path().filename().string());
      }
      if (all == 0 || finals < k) return false;
      std::this_thread::sleep_for(std::chrono::microseconds(random() % 1000));
      return true;
    });
    const auto files = contents(out);
    expectWhole(files, reference);
    killed += hit;
    const auto temporary =
        std::count_if(files.begin(), files.end(), [](const auto& file) { return isTemporary(file.first); });
    EXPECT_LE(temporary, hit ? 2 : 0) << "what earlier runs had left is still there";  // the matrix has two at once
    leftovers += static_cast<size_t>(temporary);
  }
  std::printf("%zu of %zu runs killed, %zu temporary files left\n", killed, runs, leftovers);
  EXPECT_GE(killed, runs / 2);
  // A killed run of other files leaves its temporaries to be removed, too.
  std::ofstream(out / ".another.exr.1.irad-tmp") << "half";
  ASSERT_EQ(runIrad(arguments(out)).status, 0);
  const auto files = contents(out);
  expectWhole(files, reference);
  EXPECT_EQ(files.size(), reference.size());
  EXPECT_TRUE(files.contains("manifest.json"));
}

TEST(ProgramFaults, KilledWhileExportingLeavesWholeFilesOnly) {
  killThroughout(2, smallExport);
}

TEST(ProgramFaults, KilledWhileRenderingLeavesWholeFilesOnly) {
  killThroughout(1, quickRender);
}

TEST(ProgramFaults, AFailedRunTakesTheOldManifestAway) {
  // The manifest vouched for files that now partly belong to another run.
  TemporaryFolder folder;
  ASSERT_EQ(runIrad(quickRender(folder.path)).status, 0);
  // Among the frames of the second picture.
  const RunResult failed = startIrad(smallRender(folder.path, {"--frames", "100", "--inject", "lost=610"}));
  ASSERT_EQ(failed.status, 1) << failed.err;
  EXPECT_FALSE(fs::exists(folder.path / "manifest.json"));
}

/// Whether it fails on the device, or on input that is looked at when the folder has been made.
TEST(ProgramFaults, AFailedRunLeavesNoEmptyFolder) {
  TemporaryFolder folder;
  const fs::path made = folder.path / "new", out = made / "out";
  const auto leavesNothing = [&](std::vector<std::string> arguments, const fs::path& into, int status,
                                 const std::string& said) {
    const std::string name = fmt::format("{}", fmt::join(arguments, " "));
    arguments.insert(arguments.end(), {"--out", into.string()});
    const RunResult result = runIrad(arguments);
    EXPECT_EQ(result.status, status) << name << "\n" << result.err;
    EXPECT_TRUE(contains(result.err, said)) << name << "\n" << result.err;
    EXPECT_FALSE(fs::exists(made)) << name;
    fs::remove_all(made);
  };
  const fs::path truth = writeLinear(folder.path / "truth", glm::uvec2(32, 24), std::vector<glm::vec4>(32 * 24));
  const fs::path picture = out / fmt::format("truth{}", linearExtension());
  const auto failing = [&](std::vector<std::string> command, const fs::path& into) {
    for (const char* more : {"--set", "voxel.resolution=8", "--inject", "oom=1"}) command.emplace_back(more);
    leavesNothing(command, into, 4, "out of memory");
  };
  failing({"render", "box"}, out);
  failing({"export", "box", "--matrix"}, out);
  failing({"export", "box", "--facets"}, out);
  failing({"reference", "box", "--of", "voxels", "--spp", "1000"}, picture);
  failing({"reference", "box", "--of", "matrix"}, picture);
  failing({"tune", "box", "--budget-ms", "5", "--reference", truth.string()}, out);
  failing({"study", "cost", "box", "--sweep", "matrix.rays=4", "--reference", truth.string()}, out);
  failing({"study", "attribution", "box", "--reference", truth.string()}, out);

  const std::vector<std::string> tiny{"--set", "voxel.resolution=8", "--size", "4x4"};
  const auto tooSmall = [&](std::vector<std::string> command) {
    command.insert(command.end(), tiny.begin(), tiny.end());
    leavesNothing(command, out, 2, "holds no block");
  };
  tooSmall({"tune", "box", "--budget-ms", "5", "--reference", truth.string()});
  tooSmall({"study", "cost", "box", "--sweep", "matrix.rays=4", "--reference", truth.string()});
  tooSmall({"study", "attribution", "box", "--reference", truth.string()});
  leavesNothing({"reference", "box", "--of", "matrix", "--set", "effects.matrix=off", "--set", "voxel.resolution=8"},
                picture, 2, "there is no matrix");
  const std::string shards[] = {(folder.path / "a").string(), (folder.path / "b").string()};
  for (const std::string& shard : shards) {
    fs::create_directory(shard);
    std::ofstream(fs::path(shard) / "study.json") << fmt::format(R"({{"scene": "{}", "sweeps": []}})", shard);
  }
  leavesNothing({"study", "merge", shards[0], shards[1]}, out, 3, "not the study of");
}

TEST(ProgramFaults, ABuiltInSceneIsNotHiddenByAFolderOfItsName) {
  TemporaryFolder folder;
  fs::create_directory(folder.path / "box");
  const std::string command = "cd '" + folder.path.string() + "' && '" + iradProgram() +
                              "' render box --list-devices >/dev/null && '" + iradProgram() +
                              "' export box --cache box.irscene > out 2>&1";
  EXPECT_EQ(std::system(command.c_str()), 0) << slurp(folder.path / "out");
}

// ---- Files of newer programs ----------------------------------------------------------------------------------------

TEST(NewerFiles, SettingsAndManifestsAreStatus3AndSayWhatIsUnknown) {
  TemporaryFolder folder;
  const auto run = [&](const char* text, std::vector<std::string> arguments = {"settings"}) {
    const std::string path = (folder.path / "f.json").string();
    std::ofstream(path) << text;
    arguments.insert(arguments.end(), {"--config", path});
    return runIrad(arguments);
  };
  for (
      const char* newer :
      {R"({"format": 2, "voxel.resolution": 32, "matrix.wavelengths": 7, "wind.speed": 3})",
       R"({"format": 2, "scene": 5, "settings": {"voxel.resolution": 32, "matrix.wavelengths": 7, "wind.speed": 3}})"}) {
    const RunResult result = run(newer);
    EXPECT_EQ(result.status, 3) << result.err;
    EXPECT_TRUE(contains(result.err, "f.json: is of format 2")) << result.err;
    EXPECT_TRUE(contains(result.err, "reads up to format 1; settings it does not know: matrix.wavelengths, wind.speed"))
        << result.err;
  }
  const RunResult known = run(R"({"format": 3, "voxel.resolution": 32})");
  EXPECT_EQ(known.status, 3) << "what it knows may mean something else";
  EXPECT_TRUE(contains(known.err, "format 3")) << known.err;
  EXPECT_EQ(run(R"({"format": "new"})").status, 3);
  EXPECT_EQ(run(R"({"format": -1})").status, 3);

  // A file of this format, and one from before there was a format.
  EXPECT_EQ(run(R"({"format": 1, "voxel.resolution": 32})").status, 0);
  EXPECT_EQ(run(R"({"voxel.resolution": 32})").status, 0);
  EXPECT_EQ(run(R"({"settings": {"voxel.resolution": 32}})").status, 0);
  EXPECT_EQ(nlohmann::json::parse(runIrad({"settings", "--values"}).out)["format"], 1);
}

TEST(NewerFiles, SceneCachesAreInputErrors) {
  TemporaryFolder folder;
  const fs::path path = folder.path / "box.irscene";
  writeSceneCache(loadScene(assets() / "box.glb"), path);
  std::fstream file(path, std::ios::binary | std::ios::in | std::ios::out);
  file.seekg(8);  // behind the magic: uint32 version
  const int newer = file.peek() + 1;
  file.seekp(8);
  file.put(static_cast<char>(newer));
  file.close();
  try {
    loadScene(path);
    FAIL() << "a cache of version " << newer << " is read";
  } catch (const InputError& error) {
    EXPECT_EQ(error.exitStatus, 3);
    EXPECT_TRUE(contains(error.what(), fmt::format("version {}; this program reads 2 to {}", newer, newer - 1)))
        << error.what();
  }
}

}  // namespace
}  // namespace irad::test::program_faults_suite
