// The pipeline obeys the plan: what is not called for is neither recorded nor allocated, appears with what calls for it
// and goes with it; and leaving it out changes no bit of the picture.
#include <fstream>
#include <map>
#include <nlohmann/json.hpp>

#include "renderer/csv.h"
#include "tests/effects_fixture.h"

namespace irad::test {
namespace {

class Effects : public EffectsTest {};

TEST_F(Effects, NoLightNoMatrixNoFieldNoLightBuffersAndBlack) {
  const uint64_t before = bytes({Subsystem::Matrix, Subsystem::Solver, Subsystem::Field, Subsystem::Shadow});
  timings().reset();
  Pipeline pipeline(context(), furnishedRoom(), small());
  pipeline.prepare();
  EXPECT_TRUE(pipeline.asleep());
  for (const glm::vec4& p : draw(pipeline)) ASSERT_EQ(glm::vec3(p), glm::vec3(0));
  const Stages stages = recorded();
  EXPECT_TRUE(any(stages, "GI Voxelization"));
  for (const char* stage : {"GI BuildMatrix", "GI SDF", "GI Gather", "GI Solve", "GI Scatter"})
    EXPECT_FALSE(any(stages, stage)) << stage;
  EXPECT_EQ(bytes({Subsystem::Matrix, Subsystem::Solver, Subsystem::Field}), before);
  const EffectPlan plan = pipeline.plan();
  EXPECT_TRUE(plan.off(Effect::matrix));
  EXPECT_TRUE(contains(plan.row(Effect::matrix).reason, "no light at all")) << plan.row(Effect::matrix).reason;
  EXPECT_GT(plan.row(Effect::matrix).bytesNotAllocated, 0u);
  // Views of what is not there are drawn too.
  for (const ViewInfo& view : views()) draw(pipeline, view.view);
}

TEST_F(Effects, ALightBringsTheMatrixInOnePrepareAndTakesItsMemoryWithIt) {
  Pipeline pipeline(context(), furnishedRoom(), small());
  pipeline.prepare();
  draw(pipeline);
  const uint64_t dark = bytes({Subsystem::Matrix, Subsystem::Solver, Subsystem::Field, Subsystem::Shadow});
  pipeline.setLights({lamp(0)});
  EXPECT_FALSE(pipeline.asleep());
  pipeline.prepare();
  EXPECT_TRUE(pipeline.asleep());
  EXPECT_GT(bytes({Subsystem::Matrix}), 0u);
  const std::vector<glm::vec4> lit = draw(pipeline);
  Scene scene = furnishedRoom();
  scene.lights = {lamp(0)};
  {
    Pipeline fresh(context(), scene, small());
    fresh.prepare();
    EXPECT_TRUE(same(lit, draw(fresh)));
  }
  pipeline.setLights({});
  pipeline.prepare();
  EXPECT_TRUE(pipeline.asleep());
  for (const glm::vec4& p : draw(pipeline)) ASSERT_EQ(glm::vec3(p), glm::vec3(0));
  EXPECT_EQ(bytes({Subsystem::Matrix, Subsystem::Solver, Subsystem::Field, Subsystem::Shadow}), dark);
  EXPECT_GE(pipeline.flips(), 2u);
}

TEST_F(Effects, ALightThatIsTurnedDownKeepsTheMatrixForWhenItIsTurnedUp) {
  Scene scene = furnishedRoom();
  scene.lights = {lamp(0)};
  Pipeline pipeline(context(), scene, small());
  pipeline.prepare();
  const std::vector<glm::vec4> lit = draw(pipeline);
  pipeline.setLights({lamp(0, /*candela=*/0)});
  pipeline.prepare();
  for (const glm::vec4& p : draw(pipeline)) ASSERT_EQ(glm::vec3(p), glm::vec3(0));
  EXPECT_EQ(pipeline.plan().row(Effect::matrix).state, EffectState::asleep);
  EXPECT_FALSE(pipeline.lighting());
  EXPECT_TRUE(pipeline.matrix());
  recorded();
  pipeline.setLights({lamp(0)});
  pipeline.prepare();
  EXPECT_FALSE(any(recorded(), "GI BuildMatrix"));
  EXPECT_TRUE(same(draw(pipeline), lit));  // from the dark, as before
}

TEST_F(Effects, CameraMovesRedrawAloneAndLightMovesRelightAlone) {
  Scene scene = furnishedRoom();
  scene.lights = {lamp(0)};
  Pipeline pipeline(context(), scene, small());
  pipeline.prepare();
  draw(pipeline);
  recorded();
  EXPECT_TRUE(pipeline.asleep());
  draw(pipeline);
  Stages stages = recorded();
  EXPECT_TRUE(any(stages, "RE Forward"));
  EXPECT_FALSE(any(stages, "GI ")) << "a picture alone";
  pipeline.setLights({lamp(0.1)});
  pipeline.prepare();
  stages = recorded();
  EXPECT_TRUE(any(stages, "GI Gather"));
  for (const char* stage : {"GI Voxelization", "GI SDF", "GI CompactList", "GI BuildMatrix"})
    EXPECT_FALSE(any(stages, stage)) << stage;
  // Nothing is due: nothing is recorded.
  const Counters before = context().counters();
  pipeline.prepare();
  EXPECT_EQ(context().counters().since(before).dispatches, 0u);
  EXPECT_EQ(context().counters().since(before).draws, 0u);
}

TEST_F(Effects, ADiffuseSceneHasNoSpecularPassOrTarget) {
  Scene scene = furnishedRoom();
  scene.lights = {lamp(0)};
  for (Material& m : scene.materials) m.lambertian = true;
  Pipeline pipeline(context(), scene, small());
  pipeline.prepare();
  recorded();
  Targets targets(context(), {32, 24});
  Frame frame = context().begin();
  pipeline.render(frame, scene.cameras.at(0), VIEW_LIT, targets);
  frame.submitAndWait();
  timings().endFrame(0, false, 0);
  EXPECT_FALSE(any(recorded(), "RE Specular"));
  EXPECT_FALSE(targets.specular);
  EXPECT_FALSE(targets.glossy);
  EXPECT_TRUE(pipeline.plan().off(Effect::specular));
  EXPECT_EQ(pipeline.plan().row(Effect::specular).bytesNotAllocated, 32u * 24 * 20);
}

TEST_F(Effects, LightsThatDoNotReachGetNoShadowMap) {
  Scene scene = furnishedRoom();
  Light far = lamp(100);
  far.range = 5;
  scene.lights = {lamp(0), far};
  Pipeline pipeline(context(), scene, small());
  pipeline.prepare();
  EXPECT_EQ(pipeline.shadows().cubes.desc.layers, 6u);
  scene.lights = {far};
  pipeline.setLights(scene.lights);
  pipeline.prepare();
  EXPECT_FALSE(pipeline.shadows().cubes);
  EXPECT_FALSE(holds("shadow cubes"));
  Settings forced = small();
  forced.effects.point = EffectMode::on;
  pipeline.set(forced);
  pipeline.prepare();
  EXPECT_TRUE(pipeline.shadows().cubes);
}

TEST_F(Effects, EmissionThatIsNotThereTakesNoMemory) {
  Scene scene = furnishedRoom();
  scene.lights = {lamp(0)};
  Pipeline pipeline(context(), scene, small());
  pipeline.prepare();
  EXPECT_FALSE(pipeline.facets().hasEmission);
  EXPECT_FALSE(pipeline.lighting().emitted);
  EXPECT_FALSE(holds("emitted share F M"));
  Settings forced = small();
  forced.effects.emission = EffectMode::on;
  EXPECT_EQ(pipeline.set(forced), Redo::Voxels);
  pipeline.prepare();
  EXPECT_TRUE(holds("emitted share F M"));
  pipeline.set(small());
  pipeline.prepare();
  EXPECT_FALSE(holds("emitted share F M"));
}

TEST_F(Effects, OneLitTexelLightsTheRoom) {
  SceneBuilder room;
  const uint32_t grey = room.material(glm::vec3(0.5f));
  const uint32_t lit = room.material(glm::vec3(0.5f));
  room.box({grey, grey, grey, lit, grey, grey}, glm::vec3(-1), glm::vec3(1), /*inward=*/true);
  Scene scene = room.finish("texel");
  const uint32_t size = 512;
  SceneImage image{"emissive", size, size, /*srgb=*/true, std::vector<uint8_t>(4ull * size * size, 0)};
  scene.images.push_back(image);
  scene.materials[lit].emission = glm::vec3(1000);
  scene.materials[lit].emissiveTexture.image = 0;
  {
    Pipeline dark(context(), scene, small());
    dark.prepare();
    EXPECT_TRUE(dark.plan().off(Effect::emission));
    EXPECT_TRUE(dark.plan().off(Effect::matrix));
  }
  scene.images[0].rgba[4 * (size * size / 2 + size / 2)] = 255;
  Pipeline pipeline(context(), scene, small());
  pipeline.prepare();
  EXPECT_TRUE(pipeline.plan().on(Effect::emission));
  EXPECT_TRUE(pipeline.plan().on(Effect::matrix));
  EXPECT_TRUE(pipeline.facets().hasEmission);
}

TEST_F(Effects, TheFieldFollowsTheRaysThatReadIt) {
  Scene scene = furnishedRoom();  // too rough for specular rays
  scene.lights = {lamp(0)};
  Settings dda = small();
  dda.matrix.gpu.traversal = TRAVERSAL_DDA;
  Pipeline pipeline(context(), scene, dda);
  pipeline.prepare();
  EXPECT_FALSE(pipeline.field());
  EXPECT_EQ(bytes({Subsystem::Field}), 0u);
  const std::vector<glm::vec4> without = draw(pipeline);
  // Its views make their own, and give it back.
  EXPECT_FALSE(same(draw(pipeline, VIEW_DISTANCE), without));
  EXPECT_GT(bytes({Subsystem::Field}), 0u);
  draw(pipeline);
  EXPECT_EQ(bytes({Subsystem::Field}), 0u);
  recorded();
  Settings forced = dda;
  forced.effects.field = EffectMode::on;
  pipeline.set(forced);
  EXPECT_FALSE(pipeline.asleep());
  pipeline.prepare();
  EXPECT_TRUE(pipeline.field());
  EXPECT_FALSE(any(recorded(), "GI BuildMatrix"));
  EXPECT_TRUE(same(draw(pipeline), without));
  pipeline.invalidate(Redo::Matrix);  // traced through the field
  pipeline.darken();
  pipeline.prepare();
  EXPECT_TRUE(same(draw(pipeline), without));
}

TEST_F(Effects, BlurOfEvenLightIsLeftOutWithinItsEpsilon) {
  Settings s = small();
  s.effects.blurNoise = 1e-2f;
  Pipeline pipeline(context(), furnaceBox(0.5f), s);
  pipeline.prepare();
  const EffectRow row = pipeline.plan().row(Effect::blur);
  EXPECT_EQ(row.state, EffectState::off) << row.reason;
  EXPECT_TRUE(pipeline.asleep());
  EXPECT_FALSE(pipeline.lighting().blurred);
  EXPECT_FALSE(holds("blurred H"));
  const std::vector<glm::vec4> without = draw(pipeline, VIEW_IRRADIANCE);
  s.effects.blur = EffectMode::on;
  pipeline.set(s);
  pipeline.prepare();
  EXPECT_TRUE(pipeline.lighting().blurred);
  const std::vector<glm::vec4> with = draw(pipeline, VIEW_IRRADIANCE);
  for (size_t i = 0; i < with.size(); ++i)
    ASSERT_NEAR(with[i].x, without[i].x, row.epsilon * pipeline.lighting().report.largestH);
  // Uneven light is blurred.
  Pipeline uneven(context(), lampRoom().finish("lamp"), s = small());
  uneven.prepare();
  EXPECT_TRUE(uneven.plan().on(Effect::blur)) << uneven.plan().row(Effect::blur).reason;
}

TEST_F(Effects, OffIsReallyOff) {
  const auto with = [&](const char* setting) {
    Settings s = small();
    applySetting(s, setting);
    Pipeline pipeline(context(), mixedRoom(), s);
    pipeline.prepare();
    return draw(pipeline);
  };
  const std::vector<glm::vec4> whole = with("effects.specular=auto");
  EXPECT_TRUE(same(with("effects.specular=off"), with("specular.mode=off")));
  EXPECT_TRUE(same(with("effects.second_facet=off"), with("voxel.facets=1")));
  EXPECT_TRUE(same(with("effects.blur=off"), with("sample.filter=linear")));
  for (const char* off :
       {"effects.specular=off", "effects.emission=off", "effects.point=off", "effects.sun=off", "effects.matrix=off"})
    EXPECT_FALSE(same(with(off), whole)) << off;
}

TEST_F(Effects, RelightThatIsOffLeavesTheLight) {
  Scene scene = furnishedRoom();
  scene.lights = {lamp(0)};
  Settings s = small();
  Pipeline pipeline(context(), scene, s);
  pipeline.prepare();
  const auto h = downloadAs<uint32_t>(context(), pipeline.lighting().indirect);
  s.effects.relight = EffectMode::off;
  pipeline.set(s);
  pipeline.setLights({lamp(0.3)});
  pipeline.prepare();
  EXPECT_TRUE(pipeline.asleep());
  EXPECT_EQ(downloadAs<uint32_t>(context(), pipeline.lighting().indirect), h);
  s.effects.relight = EffectMode::automatic;
  pipeline.set(s);
  EXPECT_FALSE(pipeline.asleep());
  pipeline.prepare();
  EXPECT_TRUE(pipeline.asleep());
  EXPECT_NE(downloadAs<uint32_t>(context(), pipeline.lighting().indirect), h);
  s.effects.relight = EffectMode::on;
  pipeline.set(s);
  EXPECT_FALSE(pipeline.asleep());
  recorded();
  pipeline.prepare();
  EXPECT_TRUE(any(recorded(), "GI Gather"));
}

TEST(IradPlan, PrintsTheTable) {
  const RunResult table =
      runIrad({"plan", "box", "--json", "--size", "48x36", "--set", "voxel.resolution=16", "--set", "matrix.rays=16"});
  ASSERT_EQ(table.status, 0) << table.err;
  const auto parsed = nlohmann::json::parse(table.out);
  ASSERT_EQ(parsed["effects"].size(), kEffects);
  EXPECT_EQ(parsed["effects"][0]["effect"], "emission");
  EXPECT_EQ(parsed["effects"][0]["state"], "on");
}

/// The CSV of --prove: column -> value per row.
std::vector<std::map<std::string, std::string>> provenRows(const std::vector<std::string>& scenes) {
  const std::string file = testing::TempDir() + "/proof.csv";
  std::vector<std::string> arguments{"plan"};
  arguments.insert(arguments.end(), scenes.begin(), scenes.end());
  for (const char* more : {"--prove", "--frames", "2", "--size", "48x36", "--set", "voxel.resolution=16", "--set",
                           "matrix.rays=16", "--csv"})
    arguments.push_back(more);
  arguments.push_back(file);
  const RunResult run = runIrad(arguments);
  EXPECT_EQ(run.status, 0) << run.err;
  std::vector<std::map<std::string, std::string>> rows;
  std::ifstream in(file);
  std::string line;
  std::getline(in, line);
  const std::vector<std::string> columns = csvFields(line);
  while (std::getline(in, line)) {
    const std::vector<std::string> fields = csvFields(line);
    EXPECT_EQ(fields.size(), columns.size()) << line;
    for (size_t i = 0; i < std::min(fields.size(), columns.size()); ++i)
      (i == 0 ? rows.emplace_back() : rows.back())[columns[i]] = fields[i];
  }
  return rows;
}

TEST(IradPlan, ProvesEveryRowThatIsNotOn) {
  const auto rows = provenRows({"check:lights-off", "check:plates"});
  std::map<std::string, std::map<std::string, std::map<std::string, std::string>>> of;  // scene, effect
  for (const auto& row : rows) of[row.at("scene")][row.at("effect")] = row;
  ASSERT_EQ(of.size(), 2u);
  for (auto& [scene, effects] : of) {
    // Idle, as planned, is measured, and is nothing; all forced on it is not.
    EXPECT_EQ(effects["as planned"]["idle_ms_per_s"], "0.000");
    EXPECT_EQ(effects["as planned"]["idle_dispatches_per_s"], "0.0");
    EXPECT_EQ(effects["as planned"]["idle_draws_per_s"], "0.0");
    EXPECT_GT(std::stod(effects["as planned"]["camera_ms_per_s"]), 0);
    EXPECT_GT(std::stod(effects["all forced on"]["idle_ms_per_s"]), 0);
    EXPECT_EQ(effects["all forced on"]["pixels_different"], "0");
    EXPECT_EQ(effects["all forced on"]["light_ms_per_s"], "");  // there are none to move
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
  EXPECT_EQ(of["check:plates"]["relight"]["skip"], "threshold");
  EXPECT_LE(std::stod(of["check:plates"]["relight"]["largest_difference"]),
            std::stod(of["check:plates"]["relight"]["allowed_difference"]));
  EXPECT_LE(std::stod(of["check:plates"]["emitter-sampling"]["mean_difference"]), 0.05);
}

}  // namespace
}  // namespace irad::test
