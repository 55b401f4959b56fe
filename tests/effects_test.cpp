// The pipeline obeys the plan: what is not called for is neither recorded nor allocated, appears with what calls for it
// and goes with it. (Row by row: effect_rows_test.cpp.)
#include <fstream>
#include <map>
#include <nlohmann/json.hpp>

#include "gi/plan.h"
#include "renderer/base/csv.h"
#include "renderer/shadow.h"
#include "tests/effects_fixture.h"

namespace irad::test::effects_suite {
namespace {

class Effects : public EffectsTest {
 protected:
  /// An edit after which something is due, but for `rests`.
  static Edit due(const Edit& edit, bool rests = false) {
    return [=](Pipeline& p) {
      edit(p);
      EXPECT_EQ(p.asleep(), rests);
    };
  }
  static Edit darkened(const Edit& edit) {
    return [=](Pipeline& p) {
      edit(p);
      p.darken();
    };
  }
};

/// A light brings matrix, field and light in one prepare, keeps the matrix while it is turned down, and takes all of it
/// along.
TEST_F(Effects, WithoutLightThereIsNothingOfIt) {
  const std::string nothing = "matrix off, no matrix, no solver, no field";
  const auto pipeline = prepared(furnishedRoom());
  walk(*pipeline,
       {{{}, "+GI Voxelization, -GI BuildMatrix, -GI SDF, -GI Gather, -GI Solve, -GI Scatter, " + nothing, '.'}});
  const auto shadows = [&] { return bytesOf([](const MemoryRow& row) { return row.subsystem == Subsystem::Shadow; }); };
  const uint64_t before = shadows();
  for (const ViewInfo& view : views()) draw(*pipeline, view.view);  // those of what is not there too
  recorded();
  auto pictures = walk(*pipeline, {{due(lights({lamp(0)})), "matrix on, has matrix", 'a'},
                                   {due(lights({lamp(0, /*candela=*/0)})), "matrix asleep, has matrix, no solver", '.'},
                                   {due(lights({lamp(0)})), "-GI BuildMatrix", 'a'},  // from the dark, as before
                                   {due(lights({})), nothing, '.'}});
  EXPECT_EQ(shadows(), before);
  EXPECT_GE(pipeline->flips(), 2u);
  EXPECT_TRUE(same(pictures['a'], draw(*prepared(litRoom()))));
}

TEST_F(Effects, CameraMovesRedrawAloneAndLightMovesRelightAlone) {
  const auto pipeline = prepared(litRoom());
  walk(*pipeline, {{{}, ""},
                   {{}, "+RE Forward, -GI "},
                   {lights({lamp(0.1)}), "+GI Gather, -GI Voxelization, -GI SDF, -GI CompactList, -GI BuildMatrix"}});
  // Nothing is due: nothing is recorded.
  const Counters before = context().counters();
  pipeline->prepare();
  EXPECT_EQ(context().counters().since(before).dispatches, 0u);
  EXPECT_EQ(context().counters().since(before).draws, 0u);
}

TEST_F(Effects, LightsThatDoNotReachGetNoShadowMap) {
  Light far = lamp(100);
  far.range = 5;
  Scene scene = litRoom();
  scene.lights.push_back(far);
  const auto pipeline = prepared(scene);
  EXPECT_EQ(pipeline->shadows().cubes.desc.layers, 6u);
  walk(*pipeline, {{lights({far}), "no shadow cubes"}, {setting("effects.point=on"), "has shadow cubes"}});
}

TEST_F(Effects, OneLitTexelLightsTheRoom) {
  Scene scene = room(/*emits=*/true);
  const uint32_t size = 512;
  scene.images.push_back({"emissive", size, size, /*srgb=*/true, std::vector<uint8_t>(4ull * size * size, 0)});
  for (Material& m : scene.materials) m.emissiveTexture.image = 0;
  for (const bool shines : {false, true}) {
    scene.images[0].rgba[4 * (size * size / 2 + size / 2)] = shines ? 255 : 0;
    const auto pipeline = prepared(scene);
    walk(*pipeline, {{{}, shines ? "emission on, matrix on" : "emission off, matrix off"}});
    EXPECT_EQ(pipeline->facets().hasEmission, shines);
  }
}

TEST_F(Effects, TheFieldIsMadeByItsViewsAndByForceWithoutAnotherMatrix) {
  Settings dda = small();  // the room is too rough for specular rays
  dda.matrix.gpu.traversal = Traversal::dda;
  const auto pipeline = prepared(litRoom(), dda);
  const Edit traceAnew = darkened([](Pipeline& p) { p.invalidate(Redo::Matrix); });  // through the field
  walk(*pipeline, {{{}, "no field", 'a'},
                   {{}, "has field", 'b', VIEW_DISTANCE},
                   {{}, "no field", 'a'},
                   {due(setting("effects.field=on")), "has field, -GI BuildMatrix", 'a'},
                   {traceAnew, "has field, +GI BuildMatrix", 'a'}});
}

TEST_F(Effects, OffIsReallyOff) {
  const std::pair<const char*, char> steps[]{
      {"effects.specular=auto", 'a'},    {"effects.specular=off", 'b'}, {"specular.mode=off", 'b'},
      {"effects.second_facet=off", 'c'}, {"voxel.facets=1", 'c'},       {"effects.blur=off", 'd'},
      {"sample.filter=linear", 'd'},     {"effects.emission=off", 'e'}, {"effects.point=off", 'f'},
      {"effects.sun=off", 'g'},          {"effects.matrix=off", 'h'}};
  const auto pipeline = prepared(mixedRoom());
  std::vector<Step> walked;
  for (const auto& [off, picture] : steps)
    walked.push_back({darkened([=](Pipeline& p) {
                        Settings s = small();
                        applySetting(s, off);
                        p.set(s);
                      }),
                      "", picture});
  walk(*pipeline, walked);
}

TEST_F(Effects, RelightThatIsOffLeavesTheLight) {
  const auto pipeline = prepared(litRoom());
  const View h = VIEW_IRRADIANCE;
  walk(*pipeline, {{{}, "relight asleep", 'a', h},
                   {setting("effects.relight=off"), "", 'a', h},
                   {due(lights({lamp(0.3)}), /*rests=*/true), "-GI Gather", 'a', h},
                   {due(setting("effects.relight=auto")), "+GI Gather", 'b', h},
                   {due(setting("effects.relight=on")), "+GI Gather", ' '}});
}

RunResult irad(std::vector<std::string> arguments) {
  for (const char* small : {"--size", "48x36", "--set", "voxel.resolution=16", "--set", "matrix.rays=16"})
    arguments.push_back(small);
  const RunResult run = runIrad(arguments);
  EXPECT_EQ(run.status, 0) << run.err;
  return run;
}

TEST(IradPlan, PrintsTheTable) {
  const auto parsed = nlohmann::json::parse(irad({"plan", "box", "--json"}).out);
  ASSERT_EQ(parsed["effects"].size(), kEffects);
  EXPECT_EQ(parsed["effects"][0]["effect"], "emission");
  EXPECT_EQ(parsed["effects"][0]["state"], "on");
}

TEST(IradPlan, ProvesEveryRowThatIsNotOn) {
  const std::string file = testing::TempDir() + "/proof.csv";
  irad({"plan", "check:lights-off", "check:plates", "--prove", "--frames", "2", "--csv", file});
  std::map<std::string, std::map<std::string, std::map<std::string, std::string>>> of;  // scene, effect, column
  std::ifstream in(file);
  std::string line;
  std::getline(in, line);
  const std::vector<std::string> columns = csvFields(line);
  while (std::getline(in, line)) {
    const std::vector<std::string> fields = csvFields(line);
    ASSERT_EQ(fields.size(), columns.size()) << line;
    for (size_t i = 0; i < fields.size(); ++i) of[fields[0]][fields[1]][columns[i]] = fields[i];
  }
  ASSERT_EQ(of.size(), 2u);
  for (auto& [scene, effects] : of) {
    // An idle window, as planned, is measured and takes nothing; with everything forced on it does.
    EXPECT_EQ(effects["as planned"]["idle_ms_per_s"], "0.000");
    EXPECT_EQ(effects["as planned"]["idle_dispatches_per_s"], "0.0");
    EXPECT_EQ(effects["as planned"]["idle_draws_per_s"], "0.0");
    EXPECT_GT(std::stod(effects["as planned"]["camera_ms_per_s"]), 0);
    EXPECT_GT(std::stod(effects["all forced on"]["idle_ms_per_s"]), 0);
    EXPECT_EQ(effects["all forced on"]["pixels_different"], "0");
    EXPECT_EQ(effects["all forced on"]["light_ms_per_s"], "");  // there are no lights to move
    for (auto& [name, row] : effects) {
      if (row["state"].empty()) continue;
      EXPECT_NE(row["pixels_different"].empty(), row["not_proven"].empty()) << scene << ": " << name;
      EXPECT_FALSE(row["reason"].empty()) << scene << ": " << name;
    }
    for (const char* always : {"sun", "point", "spot", "rebuild", "redraw"})
      EXPECT_EQ(effects[always]["pixels_different"], "0") << scene << ": " << always;
  }
  EXPECT_EQ(of["check:lights-off"]["matrix"]["pixels_different"], "0");
  EXPECT_GT(std::stod(of["check:lights-off"]["matrix"]["mib_not_allocated"]), 0);
  EXPECT_EQ(of["check:lights-off"]["blur"]["not_proven"], "no indirect light");
  auto& plates = of["check:plates"];
  EXPECT_EQ(plates["relight"]["skip"], "threshold");
  EXPECT_LE(std::stod(plates["relight"]["largest_difference"]), std::stod(plates["relight"]["allowed_difference"]));
  EXPECT_LE(std::stod(plates["emitter-sampling"]["mean_difference"]), 0.05);
}

}  // namespace
}  // namespace irad::test::effects_suite
