// The irad program from outside: exit statuses and messages (docs/conventions.md), and the registries.
#include <algorithm>
#include <fstream>
#include <nlohmann/json.hpp>

#include "app/progress.h"
#include "tests/scene_files.h"

namespace irad::cli_suite {
namespace {

using test::contains;
using test::runIrad;
using test::RunResult;
using test::slurp;

struct UsageCase {
  std::vector<std::string> arguments;
  std::string expected;  ///< part of the message on standard error
};

TEST(Cli, BadUsageIsStatus2AndNamesNearMatches) {
  const std::vector<UsageCase> cases{
      {{}, "no command given"},
      {{"rendr", "box"}, "unknown command 'rendr' (did you mean render?)"},
      {{"--versoin"}, "did you mean --version"},
      {{"render", "box", "--ste", "matrix.rays=4"}, "unknown option '--ste' (did you mean --set"},
      {{"render", "box", "--outt=x"}, "did you mean --out"},
      {{"render"}, "no scene given"},
      {{"render", "box", "second"}, "unexpected argument 'second'"},
      {{"render", "box", "--set"}, "--set"},
      {{"render", "box", "--set", "matrix.rayz=4"}, "did you mean matrix.rays"},
      {{"render", "box", "--set", "matrix.rays=0"}, "1 to 4096 rays"},
      {{"render", "box", "--set", "matrix.rays"}, "expected name=value"},
      {{"render", "box", "--set", "sample.filter=blurr"}, "did you mean blur"},
      {{"render", "box", "--preset", "thesys"}, "did you mean thesis"},
      {{"render", "box", "--view", "litt"}, "did you mean lit"},
      {{"render", "box", "--view", "lit,,direct"}, "an empty name"},
      {{"render", "box", "--size", "640"}, "'640' is not WIDTHxHEIGHT"},
      {{"render", "box", "--size", "0x10"}, "1 to 16384"},
      {{"render", "box", "--size", "10x99999"}, "1 to 16384"},
      {{"render", "box", "--size", "1x1", "--size", "2x2"},
       "irad render: --size is given 2 times; it may be given once"},
      {{"export", "box", "--out", "a", "--matrix", "--out", "b", "--out", "c"},
       "irad export: --out is given 3 times; it may be given once"},
      {{"render", "box", "--out", ""}, "irad render: --out is empty"},
      {{"export", "box", "--matrix", "--out="}, "--out: its value is missing: DIR"},
      {{"render", ""}, "irad render: SCENE is empty"},
      {{"render", "box", "--view", "error"},
       "--view error: there is no picture to show or compare with: --reference FILE"},
      {{"render", "box", "--view", "lit,reference-picture"}, "--view reference-picture: there is no picture"},
      {{"render", "box", "--view", "all,error"}, "--view error: there is no picture"},
      {{"render", "box", "--view", "reference"}, "--view reference: only the scenes of irad check have an oracle"},
      {{"bench", "box", "--view", "error"}, "--view error: has nothing to be drawn from here"},
      {{"render", "box", "--frames", "0"}, "--frames: '0' is not allowed"},
      {{"render", "box", "--frames", "many"}, "--frames: 'many'"},
      {{"render", "box", "--seed", "-1"}, "--seed: '-1' is not allowed; expected an integer, 0 to 4294967295"},
      {{"render", "box", "--camera", "{\"position\": [0, 1]}"}, "position: expected 3 numbers"},
      {{"render", "box", "--camera", "{\"position\": [0, 1, 2], \"targett\": [0, 0, 0]}"}, "did you mean target"},
      {{"render", "box", "--camera", "{"}, "not JSON"},
      {{"export", "box"}, "nothing to export"},
      {{"export", "box", "--volume", "radiosty"}, "did you mean radiosity"},
      {{"export", "box", "--inspect", "3,4"}, "--inspect: '3,4' is not X,Y,Z"},
      {{"export", "box", "--inspect", "3,4,x"}, "--inspect: 'x' is not allowed; expected an integer, 0 to 1023"},
      {{"bench", "box", "--versus", "matrix.fromat=csr"}, "did you mean matrix.format"},
      {{"bench", "box", "--rebuilds", "x"}, "--rebuilds: 'x'"},
      {{"reference", "box"}, "--of: triangles, voxels or matrix"},
      {{"reference", "box", "--of", "triangels"}, "--of: unknown 'triangels' (did you mean triangles?)"},
      {{"reference", "box", "--of", "triangles", "--spp", "1"}, "--spp: '1' is not allowed; expected an integer, 2 to"},
      {{"reference", "box", "--of", "triangles", "--noise", "2"}, "--noise: '2' is not allowed; expected a number"},
      {{"study"}, "irad study: which? cost | attribution | merge | pick | compare"},
      {{"study", "cots", "box"}, "unknown study 'cots' (did you mean cost?)"},
      {{"study", "cost", "box", "park"}, "unexpected argument 'park'"},
      {{"study", "cost", "box", "--sweep", "matrix.rayz=32,64"},
       "unknown setting 'matrix.rayz' (did you mean matrix.rays"},
      {{"study", "cost", "box", "--sweep", "matrix.rays=32,5000"}, "matrix.rays: '5000' is not allowed"},
      {{"study", "cost", "box", "--sweep", "matrix.rays=32..64"}, "--sweep matrix.rays: '32..64' has no step"},
      {{"study", "cost", "box", "--shard", "5/4"}, "--shard: '5/4': the part is not 1 to 4"},
      {{"tune", "box"}, "irad tune: by what? --budget-ms X, --budget-mib Y or --target-error E"},
      {{"tune", "box", "--budget-ms", "5", "--rounds", "x"}, "--rounds"},
      {{"study", "pick", "a"}, "by what? --budget-ms X, --budget-mib Y or --target-error E"},
      {{"study", "pick", "a", "--budget-ms", "-1"}, "--budget-ms: '-1' is not allowed; expected a number above 0"},
      {{"study", "pick", "a", "--budget-ms", "5", "--cost", "biuld"}, "--cost: unknown 'biuld' (did you mean build?)"},
      {{"study", "merge"}, "irad study merge: no folders given"},
      {{"study", "compare", "a.exr"}, "irad study compare: expected two pictures"},
      {{"study", "merge", "a"}, "irad study merge: no --out DIR"},
      {{"settings", "--bogus"}, "unknown option '--bogus'"},
      {{"views", "extra"}, "unexpected argument 'extra'"},
  };
  for (const UsageCase& c : cases) {
    const RunResult result = runIrad(c.arguments);
    std::string line;
    for (const std::string& a : c.arguments) line += a + " ";
    EXPECT_EQ(result.status, 2) << line << result.err;
    EXPECT_TRUE(contains(result.err, c.expected)) << line << "\n" << result.err;
    EXPECT_TRUE(contains(result.err, "irad: error:")) << line;
    EXPECT_EQ(result.out, "") << line;
  }
}

TEST(Cli, BadInputIsStatus3AndNamesTheFile) {
  test::TemporaryFolder folder;
  const auto write = [&](const char* name, const std::string& text) {
    std::ofstream(folder.path / name) << text;
    return (folder.path / name).string();
  };
  const std::string notJson = write("a.json", "{\"voxel.resolution\": "), array = write("b.json", "[1, 2]"),
                    notGltf = write("c.gltf", "this is not glTF"),
                    sizes = write("d.json", R"({"settings": {}, "size": [0, 10]})"),
                    cameras = write("e.json", R"({"settings": {}, "cameras": [{"position": 3}]})");
  const std::vector<UsageCase> cases{
      {{"render", "absent.glb"}, "absent.glb: no such file"},
      {{"render", "bxo"}, "bxo: no such file; built-in scenes (did you mean box?)"},
      {{"settings", "--config", notJson}, "a.json: not JSON"},
      {{"settings", "--config", array}, "b.json: expected a JSON object"},
      {{"settings", "--config", (folder.path / "none.json").string()}, "none.json: cannot be read"},
      {{"settings", "--config", folder.path.string()}, "cannot be read"},
      {{"render", "box", "--config", sizes}, "size: expected a whole number, 1 to 16384, not 0"},
      {{"render", "box", "--config", cameras}, "e.json: cameras[0]: position"},
      {{"render", notGltf, "--out", folder.path.string()}, "c.gltf"},
      {{"settings", "--config", write("f.json", R"({"matrix.rayz": 3})")},
       "f.json: unknown setting 'matrix.rayz' (did you mean matrix.rays"},
      {{"settings", "--config", write("g.json", R"({"matrix.rays": 0})")}, "g.json: matrix.rays: '0' is not allowed"},
      {{"render", "box", "--config", write("h.json", R"({"settings": {"matrix.rays": 99999999}})")},
       "h.json: matrix.rays: '99999999' is not allowed; expected an integer, 1 to 4096 rays"},
      {{"render", folder.path.string()}, "is a folder, not a file"},
      {{"render", "/dev/null"}, "/dev/null: is a device or a pipe, not a file"},
      {{"render", "no\xFFsuch\x1b.glb"}, "no\\xFFsuch\\x1B.glb: no such file"},
  };
  for (const UsageCase& c : cases) {
    const RunResult result = runIrad(c.arguments);
    EXPECT_EQ(result.status, 3) << c.expected << "\n" << result.err;
    EXPECT_TRUE(contains(result.err, c.expected)) << result.err;
  }
}

TEST(Cli, TimeLeftInWords) {
  EXPECT_EQ(app::timeLeft(-1), "0 s left");
  EXPECT_EQ(app::timeLeft(59.4), "59 s left");
  EXPECT_EQ(app::timeLeft(59.6), "1 min 00 s left");
  EXPECT_EQ(app::timeLeft(3599.4), "59 min 59 s left");
  EXPECT_EQ(app::timeLeft(7500), "2 h 05 min left");
}

TEST(Cli, NoSuchDeviceIsStatus4) {
  const RunResult result = runIrad({"render", "box", "--device", "no such device"});
  EXPECT_EQ(result.status, 4) << result.err;
  EXPECT_TRUE(contains(result.err, "no such device")) << result.err;
}

TEST(Cli, AFileInPlaceOfTheOutputFolderIsStatus1) {
  test::TemporaryFolder folder;
  std::ofstream(folder.path / "plain") << "x";
  const std::string out = (folder.path / "plain").string();
  const RunResult result = test::startIrad({"render", "box", "--out", out, "--set", "voxel.resolution=8"});
  EXPECT_EQ(result.status, 1) << result.err;
  EXPECT_TRUE(contains(result.err, out)) << result.err;
  EXPECT_EQ(slurp(folder.path / "plain"), "x");
}

TEST(Cli, HelpVersionAndDevicesAreStatus0) {
  const RunResult help = runIrad({"--help"});
  EXPECT_EQ(help.status, 0);
  for (const char* command :
       {"render", "bench", "export", "memory", "reference", "settings", "study", "views", "Exit status"})
    EXPECT_TRUE(contains(help.out, command)) << command;
  for (const char* command : {"render", "bench", "export", "memory", "reference", "settings", "study", "views"})
    EXPECT_EQ(runIrad({command, "--help"}).status, 0) << command;
  const RunResult version = test::startIrad({"--version"});
  EXPECT_EQ(version.status, 0);
  EXPECT_TRUE(version.out.starts_with("irad ")) << version.out;
  const RunResult devices = test::startIrad({"--list-devices"});
  EXPECT_EQ(devices.status, 0) << devices.err;
  EXPECT_TRUE(contains(devices.out, "suitable")) << devices.out;
}

TEST(Cli, RegistriesAsTableAndJson) {
  const RunResult table = test::startIrad({"settings"});
  EXPECT_EQ(table.status, 0);
  EXPECT_TRUE(contains(table.out, "voxel.resolution")) << table.out;
  const auto settings = nlohmann::json::parse(runIrad({"settings", "--json", "--set", "matrix.rays=77"}).out);
  const auto rays =
      std::find_if(settings.begin(), settings.end(), [](const auto& s) { return s["name"] == "matrix.rays"; });
  ASSERT_NE(rays, settings.end());
  EXPECT_EQ((*rays)["value"], 77);
  EXPECT_EQ((*rays)["default"], 384);
  EXPECT_EQ((*rays)["default_cpu"], 128);
  EXPECT_EQ((*rays)["unit"], "rays");
  const auto views = nlohmann::json::parse(test::startIrad({"views", "--json"}).out);
  for (const char* name : {"lit", "no-gi", "direct", "indirect", "specular", "voxel-albedo", "voxel-normal", "distance",
                           "irradiance", "radiosity", "row-occupancy"})
    EXPECT_TRUE(std::any_of(views.begin(), views.end(), [&](const auto& v) { return v["name"] == name; })) << name;
}

TEST(Cli, ValuesRoundTripThroughAFile) {
  test::TemporaryFolder folder;
  const RunResult first = runIrad({"settings", "--values", "--preset", "thesis", "--set", "solver.omega=0.7"});
  std::ofstream(folder.path / "s.json") << first.out;
  const RunResult second = runIrad({"settings", "--values", "--config", (folder.path / "s.json").string()});
  EXPECT_EQ(second.out, first.out);
  EXPECT_TRUE(contains(second.out, "\"solver.omega\": 0.7")) << second.out;
  // Later beats earlier: preset, config, set, seed.
  const auto last =
      nlohmann::json::parse(runIrad({"settings", "--values", "--preset", "fast", "--config",
                                     (folder.path / "s.json").string(), "--set", "matrix.rays=5", "--seed", "9"})
                                .out);
  EXPECT_EQ(last["voxel.normals"], "axis26");
  EXPECT_EQ(last["matrix.rays"], 5);
  EXPECT_EQ(last["matrix.seed"], 9);
}

}  // namespace
}  // namespace irad::cli_suite
