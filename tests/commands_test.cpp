// The commands from outside: files of render and export, replay to the same bits, tables of bench and check.
#include <fmt/format.h>

#include <algorithm>
#include <fstream>
#include <iterator>
#include <map>
#include <nlohmann/json.hpp>

#include "tests/support.h"
#ifdef IRAD_OIIO
#include "tests/exr.h"
#endif

namespace irad::commands_suite {
namespace {

namespace fs = std::filesystem;
using test::contains;
using test::contents;
using test::runIrad;
using test::RunResult;
using test::slurp;
using test::smallRender;
using test::startIrad;

std::vector<std::string> names(const std::map<std::string, std::string>& files) {
  std::vector<std::string> out;
  for (const auto& [name, bytes] : files) out.push_back(name);
  return out;
}

#ifdef IRAD_OIIO
constexpr const char *kDisplay = ".png", *kLinear = ".exr";
#else
constexpr const char *kDisplay = ".npy", *kLinear = ".pfm";
#endif

TEST(Render, WritesPicturesTablesAndAManifestThatReplaysToTheSameBits) {
  test::TemporaryFolder folder;
  const fs::path first = folder.path / "first", second = folder.path / "second", third = folder.path / "third";
  const RunResult run = startIrad(smallRender(first, {"--seed", "3", "--validate"}));
  ASSERT_EQ(run.status, 0) << run.err;
  for (const char* part : {"facets", "Mrays/s", "sweeps", "bound", "wrote"})
    EXPECT_TRUE(contains(run.out, part)) << part;
  EXPECT_TRUE(contains(run.err, "GI BuildMatrix")) << run.err;  // progress, as plain lines

  const auto files = contents(first);
  std::vector<std::string> expected{"irradiance",    "irradiance", "lit",        "lit",
                                    "manifest.json", "memory.csv", "timings.csv"};
  expected[0] += kDisplay;
  expected[1] += kLinear;
  expected[2] += kDisplay;
  expected[3] += kLinear;
  std::sort(expected.begin(), expected.end());
  EXPECT_EQ(names(files), expected);
  EXPECT_TRUE(
      files.at("timings.csv").starts_with("subsystem,kind,mean_ms,min_ms,max_ms,std_ms,p50_ms,p95_ms,p99_ms,samples"));
  for (const char* stage :
       {"GI Voxelization,setup,", "GI CompactList,setup,", "GI SDF,setup,", "GI BuildMatrix,setup,", "GI Gather,frame,",
        "GI Solve,frame,", "GI Scatter,frame,", "RE Shadow,frame,", "RE Depth,frame,", "RE Forward,frame,"})
    EXPECT_TRUE(contains(files.at("timings.csv"), stage)) << stage << "\n" << files.at("timings.csv");
  EXPECT_TRUE(contains(files.at("memory.csv"), "matrix entries,matrix,")) << files.at("memory.csv");
  EXPECT_TRUE(contains(files.at("memory.csv"), "all of gi (formula of the thesis),gi,,"));

  const auto manifest = nlohmann::json::parse(files.at("manifest.json"));
  EXPECT_EQ(manifest["seed"], 3);
  EXPECT_EQ(manifest["settings"]["voxel.resolution"], 12);
  EXPECT_EQ(manifest["size"], (nlohmann::json{64, 48}));
  EXPECT_EQ(manifest["views"], (nlohmann::json{"lit", "irradiance"}));
  EXPECT_EQ(manifest["scene"]["sha256"].get<std::string>().size(), 64u);
  EXPECT_EQ(manifest["cameras"].size(), 1u);
  EXPECT_FALSE(manifest["device"]["name"].get<std::string>().empty());
  EXPECT_FALSE(manifest["program"]["commit"].get<std::string>().empty());

  // Replay from the manifest alone.
  const std::string path = (first / "manifest.json").string();
  ASSERT_EQ(runIrad({"render", "--config", path, "--out", second.string()}).status, 0);
  auto replay = contents(second);
  EXPECT_EQ(names(replay), names(files));
  for (const auto& [name, bytes] : files) {
    if (name == "timings.csv") continue;
    EXPECT_TRUE(replay[name] == bytes) << name;
  }

  // And replay from the command line that it states, as a shell reads it.
  const std::string command = manifest["command"];
  ASSERT_TRUE(command.starts_with("irad render ")) << command;
  const std::string shell = std::string("'") + test::iradProgram() + "'" + command.substr(4) + " --out '" +
                            third.string() + "' >/dev/null 2>&1";
  ASSERT_EQ(std::system(shell.c_str()), 0) << shell;
  auto typed = contents(third);
  for (const auto& [name, bytes] : files) {
    if (name == "timings.csv") continue;
    EXPECT_TRUE(typed[name] == bytes) << name;
  }
}

TEST(Render, AnotherSeedGivesOtherBits) {
  test::TemporaryFolder folder;
  ASSERT_EQ(runIrad(smallRender(folder.path / "a", {"--seed", "1"})).status, 0);
  ASSERT_EQ(runIrad(smallRender(folder.path / "b", {"--seed", "2"})).status, 0);
  const std::string exr = std::string("lit") + kLinear;
  EXPECT_FALSE(slurp(folder.path / "a" / exr) == slurp(folder.path / "b" / exr));
}

TEST(Render, FramesAreSamplesAndTheLastIsThePicture) {
  test::TemporaryFolder folder;
  ASSERT_EQ(runIrad(smallRender(folder.path / "one", {"--view", "lit"})).status, 0);
  ASSERT_EQ(runIrad(smallRender(folder.path / "many", {"--frames", "4"})).status, 0);
  const std::string csv = slurp(folder.path / "many" / "timings.csv");
  const size_t row = csv.find("RE Forward,frame,");
  ASSERT_NE(row, std::string::npos);
  const std::string line = csv.substr(row, csv.find('\n', row) - row);
  EXPECT_EQ(line.substr(line.rfind(',') + 1), "8");  // two views, four frames each
  const std::string exr = std::string("lit") + kLinear;
  EXPECT_TRUE(slurp(folder.path / "one" / exr) == slurp(folder.path / "many" / exr));
}

TEST(Render, SeveralCamerasArePartOfTheNames) {
  test::TemporaryFolder folder;
  const std::string json = R"({"name": "above", "position": [0, 4, 9], "target": [0, 4, 0], "yfov": 0.8})";
  const RunResult run = runIrad(smallRender(folder.path, {"--view", "no-gi", "--camera", json, "--camera", json}));
  ASSERT_EQ(run.status, 0) << run.err;
  for (const char* stem : {"above.lit", "above-2.lit", "above.no-gi", "above-2.irradiance"})
    EXPECT_TRUE(fs::exists(folder.path / (std::string(stem) + kLinear))) << stem;
  EXPECT_TRUE(slurp(folder.path / (std::string("above.lit") + kLinear)) ==
              slurp(folder.path / (std::string("above-2.lit") + kLinear)));
  const RunResult wrong = runIrad(smallRender(folder.path / "x", {"--camera", "no such camera"}));
  EXPECT_EQ(wrong.status, 2);
  EXPECT_TRUE(contains(wrong.err, "unknown camera 'no such camera'")) << wrong.err;
}

TEST(Render, ReferenceAndRangesAreStatedAndReplayed) {
  test::TemporaryFolder folder;
  ASSERT_EQ(runIrad(smallRender(folder.path / "a")).status, 0);
  const std::string reference = (folder.path / "a" / (std::string("lit") + kLinear)).string();
  const RunResult run = runIrad(smallRender(
      folder.path / "b", {"--view", "error,depth,distance-jfa", "--reference", reference, "--set",
                          "view.range=percentile", "--set", "view.shape=isosurface", "--set", "view.color_map=heat"}));
  ASSERT_EQ(run.status, 0) << run.err;
  const auto manifest = nlohmann::json::parse(slurp(folder.path / "b" / "manifest.json"));
  EXPECT_EQ(manifest["reference"]["path"], reference);
  ASSERT_EQ(manifest["view_ranges"].size(), 3u);  // lit and irradiance have none
  const auto& error = manifest["view_ranges"][0];
  EXPECT_EQ(error["picture"], "error");
  EXPECT_EQ(error["high"], 0);  // against itself
  EXPECT_EQ(error["color_map"], "blue-red");
  const auto& depth = manifest["view_ranges"][1];
  EXPECT_EQ(depth["unit"], "m");
  EXPECT_EQ(depth["color_map"], "heat");
  EXPECT_LT(depth["low"].get<double>(), depth["high"].get<double>());

  ASSERT_EQ(runIrad({"render", "--config", (folder.path / "b" / "manifest.json").string(), "--out",
                     (folder.path / "c").string()})
                .status,
            0);
  for (const char* view : {"error", "depth", "distance-jfa"})
    for (const char* kind : {kLinear, kDisplay})
      EXPECT_TRUE(slurp(folder.path / "b" / (std::string(view) + kind)) ==
                  slurp(folder.path / "c" / (std::string(view) + kind)))
          << view << kind;

  const RunResult other = runIrad({"render", "box", "--size", "32x16", "--view", "error", "--reference", reference,
                                   "--out", (folder.path / "d").string()});
  EXPECT_EQ(other.status, 2);
  EXPECT_TRUE(contains(other.err, "64 x 48 pixels, the pictures have 32 x 16: --size 64x48")) << other.err;
  EXPECT_FALSE(fs::exists(folder.path / "d"));

  const RunResult missing = runIrad(smallRender(folder.path / "d", {"--reference", "/nowhere.exr"}));
  EXPECT_EQ(missing.status, 3);
  EXPECT_TRUE(contains(missing.err, "/nowhere.exr")) << missing.err;
}

TEST(CheckCommand, ListsRunsAndFails) {
  const RunResult list = runIrad({"check", "--list"});
  EXPECT_EQ(list.status, 0);
  for (const char* name : {"furnace-box", "facing-mirrors", "divergence"})
    EXPECT_TRUE(contains(list.out, name)) << list.out;
  const RunResult slip = runIrad({"check", "furnace-bux"});
  EXPECT_EQ(slip.status, 2);
  EXPECT_TRUE(contains(slip.err, "furnace-box")) << slip.err;

  const test::TemporaryFolder folder;
  const std::string json = (folder.path / "c.json").string(), csv = (folder.path / "c.csv").string();
  const std::vector<std::string> coarse{"--set", "voxel.resolution=16", "--set", "matrix.rays=32"};
  std::vector<std::string> good{"check", "furnace-box", "facing-mirrors", "--json", json, "--csv", csv};
  good.insert(good.end(), coarse.begin(), coarse.end());
  const RunResult passed = runIrad(good);
  EXPECT_EQ(passed.status, 0) << passed.err;
  EXPECT_TRUE(contains(passed.out, "2 passed, 0 failed")) << passed.out;
  const nlohmann::json report = nlohmann::json::parse(std::ifstream(json));
  EXPECT_EQ(report.at("cases").at(0).at("status"), "pass");
  EXPECT_EQ(report.at("cases").at(1).at("status"), "pass");
  const nlohmann::json& figure = report.at("cases").at(0).at("figures").at(0);
  EXPECT_NEAR(figure.at("value").get<double>(), 1.0, 0.001);
  EXPECT_LT(figure.at("thesis").get<double>(), 0.9) << "lambda .8 solves another system";
  std::ifstream table(csv);
  std::string heading;
  std::getline(table, heading);
  EXPECT_EQ(heading, "case,status,figure,value,mark,passed,thesis,milliseconds");

  // A setting that breaks the physics breaks the case.
  std::vector<std::string> bad{"check", "furnace-box", "--quick", "--set", "solver.lambda=0.9"};
  bad.insert(bad.end(), coarse.begin(), coarse.end());
  const RunResult failed = startIrad(bad);
  EXPECT_EQ(failed.status, 1);
  EXPECT_TRUE(contains(failed.out, "FAIL") && contains(failed.out, "0 passed, 1 failed")) << failed.out;
}

TEST(CheckCommand, ScenesOpenByNameWithTheirOracle) {
  const test::TemporaryFolder folder;
  const std::string out = folder.path.string();
  const RunResult run = runIrad({"render", "check:furnace-box", "--view", "reference,voxel-irradiance", "--size",
                                 "16x16", "--set", "voxel.resolution=16", "--set", "matrix.rays=64", "--out", out});
  ASSERT_EQ(run.status, 0) << run.err;
#ifdef IRAD_OIIO
  const test::ExrPicture oracle = test::readExr(folder.path / "reference.exr"),
                         ours = test::readExr(folder.path / "voxel-irradiance.exr");
  for (const glm::vec3& p : oracle.pixels) EXPECT_EQ(p.x, 2.0f);
  for (const glm::vec3& p : ours.pixels) EXPECT_NEAR(p.x, 2.0, 0.01);
#endif
  // Its manifest names the case, and replays from anywhere.
  const TemporaryFolder replayed;
  const RunResult replay =
      runIrad({"render", "--config", (folder.path / "manifest.json").string(), "--out", replayed.path.string()});
  EXPECT_EQ(replay.status, 0) << replay.err;
  const std::string linear = std::string("reference") + kLinear;
  EXPECT_TRUE(slurp(folder.path / linear) == slurp(replayed.path / linear));
  EXPECT_EQ(runIrad({"render", "check:sampler-of-nothing", "--out", out}).status, 2);
}

TEST(ExportCommand, ArraysAndTheirPlaceInTheWorld) {
  test::TemporaryFolder folder;
  const RunResult run = runIrad({"export", "box", "--out", folder.path.string(), "--volume", "all", "--matrix",
                                 "--facets", "--set", "voxel.resolution=16", "--set", "matrix.rays=16"});
  ASSERT_EQ(run.status, 0) << run.err;
  for (const char* name : {"radiosity", "irradiance", "albedo", "normal", "emission", "distance", "indptr", "indices",
                           "data", "facet_position", "facet_radiosity"})
    EXPECT_TRUE(fs::exists(folder.path / (std::string(name) + ".npy"))) << name;
  const auto manifest = nlohmann::json::parse(slurp(folder.path / "manifest.json"));
  EXPECT_EQ(manifest["files"].size(), 17u);
  const auto dims = manifest["grid"]["dims"];
  EXPECT_EQ(std::max({dims[0].get<int>(), dims[1].get<int>(), dims[2].get<int>()}),
            18);  // 16 and one of padding per side
  EXPECT_TRUE(contains(slurp(folder.path / "distance.npy"), fmt::format("'shape': ({}, {}, {})", dims[2].get<int>(),
                                                                        dims[1].get<int>(), dims[0].get<int>())));
}

TEST(ExportCommand, TheRecordOfAVoxel) {
  test::TemporaryFolder folder;
  const auto inspect = [&](const std::string& voxel) {
    return runIrad({"export", "check:furnace-box", "--out", folder.path.string(), "--inspect", voxel, "--set",
                    "voxel.resolution=16", "--set", "matrix.rays=32"});
  };
  const RunResult run = inspect("1,8,8");
  ASSERT_EQ(run.status, 0) << run.err;
  const auto record = nlohmann::json::parse(slurp(folder.path / "inspect.json"));
  EXPECT_EQ(record["voxel"], (nlohmann::json{1, 8, 8}));
  const auto& facet = record["facets"].at(0);
  EXPECT_NEAR(facet["row"]["sum"].get<double>(), 1, 1e-6);
  EXPECT_NEAR(facet["irradiance"][0].get<double>(), 2, 0.01);
  EXPECT_EQ(facet["irradiance_history"][0], (nlohmann::json{0.0, 0.0, 0.0}));  // from the dark
  EXPECT_GT(facet["irradiance_history"].size(), 5u);
  const auto manifest = nlohmann::json::parse(slurp(folder.path / "manifest.json"));
  EXPECT_EQ(manifest["files"], (nlohmann::json{"inspect.json"}));
  EXPECT_TRUE(contains(manifest["command"], "--inspect 1,8,8")) << manifest["command"];
  for (const char* voxel : {"5,8,8", "1,8,40"}) {
    fs::remove(folder.path / "inspect.json");
    const RunResult bad = inspect(voxel);
    EXPECT_EQ(bad.status, 2) << bad.err;
    EXPECT_TRUE(contains(bad.err, fmt::format("voxel {} ", voxel))) << bad.err;
    EXPECT_TRUE(contains(bad.err, "18 x 18 x 18 voxels; the nearest solid voxel is 1,8,")) << bad.err;
    EXPECT_FALSE(fs::exists(folder.path / "inspect.json"));
  }
}

TEST(ExportCommand, NumpyReadsMatrixVolumesAndFacets) {
  if (std::system("/usr/bin/python3 -c 'import numpy' 2>/dev/null") != 0) GTEST_SKIP() << "python3-numpy is not here";
  TemporaryFolder folder;
  const RunResult run =
      startIrad({"export", "box", "--out", folder.path.string(), "--volume", "albedo,distance", "--matrix", "--facets",
                 "--format", "npy,csv", "--set", "voxel.resolution=16", "--set", "matrix.rays=16"});
  ASSERT_EQ(run.status, 0) << run.err;
  // The CSR triple is in range, its rows are shares of 1; the table holds the arrays' bits; a facet's voxel is solid.
  const std::string script = R"(
import json, sys, numpy as n
d = sys.argv[1] + "/"
load = lambda name: n.load(d + name + ".npy")
indptr, indices, data, voxel = load("indptr"), load("indices"), load("data"), load("facet_voxel")
rows = len(indptr) - 1
assert rows == len(voxel) > 1000 and indptr[0] == 0 and indptr[-1] == len(indices) == len(data)
assert (n.diff(indptr) >= 0).all() and indices.min() >= 0 and indices.max() < rows
sums = n.add.reduceat(data, indptr[:-1][n.diff(indptr) > 0])
assert data.min() > 0 and .9 < n.median(sums) <= sums.max() < 1 + 1e-5
table = n.genfromtxt(d + "facets.csv", delimiter=",", names=True, dtype=None)
assert len(table) == rows
for name in ["position", "normal", "albedo", "emission", "direct", "irradiance", "radiosity"]:
    array = load("facet_" + name)
    assert array.shape == (rows, 3) and array.dtype == n.float32, name
    for axis, letter in enumerate("xyz"):
        assert (table[name + "_" + letter].astype(n.float32) == array[:, axis]).all(), name
distance, grid = load("distance"), json.load(open(d + "manifest.json"))["grid"]
assert list(distance.shape) == grid["dims"][::-1]
assert (distance[voxel[:, 2], voxel[:, 1], voxel[:, 0]] == 0).all()
assert load("albedo").shape == distance.shape + (3,)
)";
  std::ofstream(folder.path / "read.py") << script;
  const RunResult python =
      test::runProgram("/usr/bin/python3", {(folder.path / "read.py").string(), folder.path.string()});
  EXPECT_EQ(python.status, 0) << python.err;

  const RunResult wrong = runIrad({"export", "box", "--facets", "--format", "vdb"});
  EXPECT_EQ(wrong.status, 2);
  EXPECT_TRUE(contains(wrong.err, "--format vdb is for --volume")) << wrong.err;
  EXPECT_TRUE(contains(runIrad({"export", "box", "--volume", "albedo", "--format", "npz"}).err, "did you mean npy?"));
}

TEST(BenchCommand, TableCsvAndRatios) {
  test::TemporaryFolder folder;
  const std::string csv = (folder.path / "bench.csv").string();
  const RunResult run = runIrad({"bench",      "box",
                                 "--size",     "64x48",
                                 "--set",      "voxel.resolution=16",
                                 "--set",      "matrix.rays=16",
                                 "--set",      "light.shadow_resolution=64",
                                 "--frames",   "3",
                                 "--rebuilds", "2",
                                 "--warmup",   "1",
                                 "--csv",      csv,
                                 "--versus",   "matrix.jitter=false",
                                 "--versus",   "matrix.traversal=dda"});
  ASSERT_EQ(run.status, 0) << run.err;
  for (const char* part : {"GI BuildMatrix", "RE Forward", "Mrays/s", "GB/s", "copy bandwidth", "versus / settings"})
    EXPECT_TRUE(contains(run.out, part)) << part << "\n" << run.out;
  const std::string rows = slurp(csv);
  EXPECT_TRUE(rows.starts_with("set,subsystem,kind,mean_ms,min_ms,max_ms,std_ms,p50_ms,p95_ms,p99_ms,samples\n"));
  EXPECT_TRUE(contains(rows, "\nversus,GI BuildMatrix,setup,"));
  const auto samples = [&](const std::string& start) {
    const size_t row = rows.find(start);
    if (row == std::string::npos) return "no row " + start;
    const std::string line = rows.substr(row, rows.find('\n', row) - row);
    return line.substr(line.rfind(',') + 1);
  };
  EXPECT_EQ(samples("settings,GI BuildMatrix,setup,"), "2");
  EXPECT_EQ(samples("versus,GI Voxelization,setup,"), "2");
  EXPECT_EQ(samples("settings,GI Solve,cold,"), "2");
  EXPECT_EQ(samples("settings,GI Solve,relight,"), "3");
  EXPECT_EQ(samples("versus,RE Forward,camera,"), "3");
  EXPECT_EQ(samples("settings,wall,camera,"), "3");
}

TEST(BenchCommand, RecordsAndCompares) {
  test::TemporaryFolder folder;
  const std::string out = (folder.path / "new" / "recording").string();
  const RunResult run = startIrad({"bench",      "box",
                                   "--size",     "48x48",
                                   "--set",      "voxel.resolution=16",
                                   "--set",      "matrix.rays=16",
                                   "--set",      "light.shadow_resolution=64",
                                   "--frames",   "12",
                                   "--rebuilds", "1",
                                   "--warmup",   "1",
                                   "--record",   out,
                                   "--versus",   "solver.omega=0.5"});
  ASSERT_EQ(run.status, 0) << run.err;
  const auto first = contents(fs::path(out) / "settings"), second = contents(fs::path(out) / "versus");
  EXPECT_EQ(names(first), (std::vector<std::string>{"frames.csv", "manifest.json", "summary.csv", "trace.json"}));
  EXPECT_EQ(names(second), names(first));
  // 1 rebuild with its cold relight, 12 relights, 12 pictures.
  EXPECT_EQ(std::count(first.at("frames.csv").begin(), first.at("frames.csv").end(), '\n'), 1 + 2 + 12 + 12);
  EXPECT_TRUE(contains(first.at("summary.csv"), "\nGI Solve,relight,")) << first.at("summary.csv");
  const auto trace = nlohmann::json::parse(first.at("trace.json"));
  EXPECT_EQ(trace["otherData"]["scene"], "box.glb");
  // What was timed is beside it, and in the trace; its command line times the same again.
  const auto manifest = nlohmann::json::parse(first.at("manifest.json"));
  EXPECT_EQ(trace["otherData"]["manifest"], manifest);
  EXPECT_EQ(manifest["settings"]["matrix.rays"], 16);
  EXPECT_EQ(manifest["size"], (nlohmann::json{48, 48}));
  EXPECT_EQ(manifest["cameras"].size(), 1u);
  EXPECT_EQ(nlohmann::json::parse(second.at("manifest.json"))["settings"]["solver.omega"], 0.5);
  EXPECT_TRUE(contains(manifest["command"], "irad bench /") && contains(manifest["command"], "--rebuilds 1"))
      << manifest["command"];
  // On the GPU's track nothing overlaps, and every group's passes follow the beginning of its work on the CPU.
  std::map<int, double> ended;
  for (const auto& event : trace["traceEvents"]) {
    if (event["ph"] != "X") continue;
    const double began = event["ts"], microseconds = event["dur"];
    EXPECT_GE(began, ended[event["tid"]] - 1) << event;
    ended[event["tid"]] = began + microseconds;
  }
  EXPECT_EQ(ended.size(), 2u);

  const auto compare = [&](const std::string& a, const std::string& b) {
    return runIrad({"bench", "--compare", a, b});
  };
  const RunResult same = compare(out + "/settings", out + "/settings");
  EXPECT_EQ(same.status, 0) << same.err;
  EXPECT_TRUE(contains(same.out, "within noise")) << same.out;
  EXPECT_TRUE(contains(same.out, "too few samples")) << same.out;
  EXPECT_FALSE(contains(same.out, "slower") || contains(same.out, "faster")) << same.out;
  EXPECT_TRUE(contains(compare(out + "/settings", out + "/versus").out, "GI Solve"));
  const RunResult absent = compare(out + "/settings", out + "/none");
  EXPECT_EQ(absent.status, 3);
  EXPECT_TRUE(contains(absent.err, "none/frames.csv: cannot be read")) << absent.err;
  EXPECT_EQ(runIrad({"bench", "--compare", out}).status, 2);
}

TEST(BenchCommand, TheWindowsCostNeedsAWindow) {
  const char* before = std::getenv("DISPLAY");
  const std::string kept = before ? before : "";
  setenv("DISPLAY", ":987", 1);
  const RunResult run = startIrad({"bench", "box", "--ui", "--frames", "10"});
  before ? setenv("DISPLAY", kept.c_str(), 1) : unsetenv("DISPLAY");
#if IRAD_UI
  EXPECT_EQ(run.status, 4) << run.err;
  EXPECT_TRUE(contains(run.err, "no window")) << run.err;
#else
  EXPECT_EQ(run.status, 2) << run.err;
  EXPECT_TRUE(contains(run.err, "built without its window")) << run.err;
#endif
  EXPECT_EQ(run.out, "");
}

}  // namespace
}  // namespace irad::commands_suite
