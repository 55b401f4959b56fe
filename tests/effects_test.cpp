// The pipeline obeys the plan: what is not called for is neither recorded nor allocated, appears with what calls for it
// and goes with it. (Row by row: effect_rows_test.cpp.)
#include <cmath>
#include <fstream>
#include <map>
#include <nlohmann/json.hpp>
#include <set>

#include "gi/plan.h"
#include "renderer/base/csv.h"
#include "renderer/shadow.h"
#include "tests/effects_fixture.h"

namespace irad::test::effects_suite {
namespace {

class Effects : public EffectsTest {
 protected:
  static Scene litRoom(std::vector<Light> lights = {lamp(0)}) {
    Scene scene = furnishedRoom();
    scene.lights = std::move(lights);
    return scene;
  }
};

/// A light brings matrix, field and light in one prepare, keeps the matrix while it is turned down, and takes all of it
/// along.
TEST_F(Effects, WithoutLightThereIsNothingOfIt) {
  const std::string nothing =
      "-GI BuildMatrix, -GI SDF, -GI Gather, -GI Solve, -GI Scatter, matrix off, -has matrix, -has solver, -has field";
  const auto bench = this->bench(furnishedRoom());
  walk(bench->pipeline(), {{{}, "GI Voxelization, GI CompactList, " + nothing, '.'}});
  for (const ViewInfo& view : views()) draw(bench->pipeline(), view.view);  // those of what is not there too
  recorded();
  walk(bench->pipeline(),
       {{{}, nothing, '.'},
        {lights({lamp(0)}), "matrix on, has matrix, has solver, has field, GI SDF, GI BuildMatrix", 'a'},
        {{}, "RE Forward, -GI ", 'a'},  // a camera that moves
        {lights({lamp(0.1)}), "GI Gather, -GI Voxelization, -GI SDF, -GI CompactList, -GI BuildMatrix", 'b'},
        {lights({lamp(0, /*candela=*/0)}), "matrix asleep, has matrix, -has solver", '.'},
        {lights({lamp(0)}), "-GI BuildMatrix, GI Solve, GI Scatter", 'a'},  // from the dark, as before
        {lights({}), nothing, '.'}});
  walk(this->bench(litRoom())->pipeline(), {{{}, "", 'a'}});
}

TEST_F(Effects, LightsThatDoNotReachGetNoShadowMap) {
  Light far = lamp(100);
  far.range = 5;
  const auto bench = this->bench(litRoom({lamp(0), far}));
  EXPECT_EQ(bench->pipeline().shadows().cubes.desc.layers, 6u);
  walk(bench->pipeline(), {{lights({far}), "-has shadow cubes"}, {setting("effects.point=on"), "has shadow cubes"}});
}

TEST_F(Effects, TheFieldIsMadeByItsViewsAndByForceWithoutAnotherMatrix) {
  Settings dda = small();  // the room is too rough for specular rays
  dda.matrix.gpu.traversal = Traversal::dda;
  const Edit traceAnew = [](Pipeline& p) {  // through the field
    p.invalidate(Redo::Matrix);
    p.darken();
  };
  walk(bench(litRoom(), dda)->pipeline(), {{{}, "-has field", 'a'},
                                           {{}, "has field", 'b', VIEW_DISTANCE},
                                           {{}, "-has field", 'a'},
                                           {setting("effects.field=on"), "has field, -GI BuildMatrix", 'a'},
                                           {traceAnew, "has field, GI BuildMatrix", 'a'}});
}

TEST_F(Effects, RelightThatIsOffLeavesTheLight) {
  const View h = VIEW_IRRADIANCE;
  walk(bench(litRoom())->pipeline(), {{{}, "relight asleep", 'a', h},
                                      {setting("effects.relight=off"), "", 'a', h},
                                      {lights({lamp(0.3)}), "-GI Gather", 'a', h},
                                      {setting("effects.relight=auto"), "GI Gather", 'b', h},
                                      {setting("effects.relight=on"), "GI Gather", ' ', h}});
}

RunResult irad(std::vector<std::string> arguments) {
  for (const char* small : {"--size", "48x36", "--set", "voxel.resolution=16", "--set", "matrix.rays=16"})
    arguments.push_back(small);
  const RunResult run = runIrad(arguments);
  EXPECT_EQ(run.status, 0) << run.err;
  return run;
}

TEST(IradPlan, PrintsTheTableWithWhatEachEffectThatIsOffWouldTake) {
  const auto parsed = nlohmann::json::parse(irad({"plan", "box", "--json", "--measure", "--frames", "1"}).out);
  ASSERT_EQ(parsed["effects"].size(), kEffects);
  EXPECT_EQ(parsed["effects"][0]["effect"], "emission");
  EXPECT_EQ(parsed["effects"][0]["state"], "on");
  size_t measured = 0;
  for (const auto& row : parsed["effects"]) {
    EXPECT_EQ(row.contains("ms_not_spent"), row["state"] == "off") << row;  // each of them can be on
    for (const char* kind : {"rebuild", "relight", "frame"})
      measured += row.contains("ms_not_spent") && std::isfinite(row["ms_not_spent"][kind].get<double>()) ? 1 : 0;
  }
  EXPECT_GE(measured, 3u);
}

/// (What is compared and does not hold fails the command.)
TEST(IradPlan, ProvesEveryRowThatIsNotOn) {
  const std::string file = testing::TempDir() + "/proof.csv";
  irad({"plan", "check:lights-off", "check:plates", "--prove", "--frames", "2", "--csv", file});
  std::ifstream in(file);
  std::string line;
  std::getline(in, line);
  const std::vector<std::string> columns = csvFields(line);
  std::map<std::string, std::map<std::string, std::string>> rows;  // "SCENE EFFECT", column
  std::set<std::string> notProven;
  while (std::getline(in, line)) {
    const std::vector<std::string> fields = csvFields(line);
    ASSERT_EQ(fields.size(), columns.size()) << line;
    auto& row = rows[fields[0] + " " + fields[1]];
    for (size_t i = 0; i < fields.size(); ++i) row[columns[i]] = fields[i];
    EXPECT_TRUE(row["state"].empty() || row["pixels_different"].empty() != row["not_proven"].empty()) << line;
    EXPECT_EQ(row["state"].empty(), row["reason"].empty()) << line;
    if (!row["not_proven"].empty()) notProven.insert(fields[1] + ": " + row["not_proven"]);
  }
  EXPECT_EQ(notProven, (std::set<std::string>{"emitter-sampling: nothing emits", "relight: no indirect light",
                                              "blur: no indirect light"}));
  for (const std::string scene : {"check:lights-off ", "check:plates "}) {
    // An idle window, as planned, is measured and takes nothing; with everything forced on it does.
    auto &planned = rows.at(scene + "as planned"), &forced = rows.at(scene + "all forced on");
    for (const char* idle : {"idle_ms_per_s", "idle_dispatches_per_s", "idle_draws_per_s"}) {
      EXPECT_EQ(std::stod(planned[idle]), 0) << idle;
      EXPECT_GT(std::stod(forced[idle]), 0) << idle;
    }
    EXPECT_GT(std::stod(planned["camera_ms_per_s"]), 0);
    EXPECT_EQ(forced["pixels_different"], "0");
    EXPECT_EQ(forced["light_ms_per_s"], "");  // there are no lights to move
    for (const char* off : {"sun", "point", "spot", "rebuild", "redraw"})
      EXPECT_TRUE(rows.contains(scene + off)) << off;
  }
  for (const char* off : {"emission", "matrix", "specular", "field", "alpha-test", "normal-map"})
    EXPECT_TRUE(rows.contains(std::string("check:lights-off ") + off)) << off;
  EXPECT_GT(std::stod(rows["check:lights-off matrix"]["mib_not_allocated"]), 0);
  EXPECT_EQ(rows["check:lights-off specular"]["mib_not_allocated"], "0.033");  // 48 x 36 x 20 B
}

}  // namespace
}  // namespace irad::test::effects_suite
