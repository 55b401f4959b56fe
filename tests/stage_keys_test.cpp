// A stage is due where what it reads has changed by content, and only there.
#include "gi/stage_keys.h"

#include <set>

#include "gi/pipeline.h"
#include "renderer/base/error.h"
#include "tests/effects_fixture.h"
#include "tests/setting_values.h"

namespace irad::test::stage_keys_suite {
namespace {

TEST(StageKeys, EverySettingMakesItsStageDueAndNoEarlierOne) {
  const SceneContent content{1, 2};
  const Settings before = defaultSettings(/*cpuDevice=*/true);
  for (const Setting& setting : settingTable()) {
    Settings after = before;
    setting.set(after, anotherValue(setting, before));
    ASSERT_NE(before, after) << setting.name;
    ASSERT_NE(setting.text(before), setting.text(after)) << setting.name;
    const Redo expected = setting.redo < Redo::Shade ? setting.redo : Redo::Nothing;
    EXPECT_EQ(firstDifference(stageKeys(content, before), stageKeys(content, after)), expected) << setting.name;
    EXPECT_EQ(firstDifference(before, after), expected) << setting.name;
  }
  EXPECT_GT(settingTable().size(), 50u);
}

TEST(StageKeys, OfSeveralSettingsTheFirstStageIsDue) {
  Settings a, b;
  const auto first = [&] { return firstDifference(a, b); };
  EXPECT_EQ(first(), Redo::Nothing);
  EXPECT_EQ(a, b);
  b.camera.exposureEv = 2;
  EXPECT_EQ(first(), Redo::Nothing);
  b.specular.gpu.rays = 9;
  EXPECT_EQ(first(), Redo::Nothing) << "shading alone";
  EXPECT_NE(a, b);
  b.solver.gpu.lambda = 0.5f;
  EXPECT_EQ(first(), Redo::Solve);
  b.matrix.gpu.seed = 1;
  EXPECT_EQ(first(), Redo::Matrix);
  b.voxel.resolution = 9;
  EXPECT_EQ(first(), Redo::Voxels);
}

TEST(StageKeys, SurfacesAreWhatVoxelsAreMadeOfLightsWhatIsGathered) {
  const Settings s = defaultSettings(true);
  const StageKeys keys = stageKeys({1, 2}, s);
  EXPECT_EQ(firstDifference(keys, stageKeys({1, 2}, s)), Redo::Nothing);
  EXPECT_EQ(firstDifference(keys, stageKeys({3, 2}, s)), Redo::Voxels);
  EXPECT_EQ(firstDifference(keys, stageKeys({1, 3}, s)), Redo::Gather);
  EXPECT_EQ(firstDifference({}, keys), Redo::Voxels) << "nothing was made";
  StageKeys forgotten = keys;
  forgotten.forget(Redo::Solve);
  EXPECT_EQ(firstDifference(forgotten, keys), Redo::Solve);
}

TEST(SurfaceContent, IsOfEveryVertexMaterialAndTexel) {
  Scene scene = furnishedRoom();
  scene.images.push_back({"checks", 2, 2, true, std::vector<uint8_t>(16, 255)});
  scene.materials[0].baseColorTexture.image = 0;
  const uint64_t before = surfaceContent(scene);
  EXPECT_EQ(surfaceContent(Scene(scene)), before);
  const std::pair<const char*, std::function<void(Scene&)>> edits[]{
      {"a vertex moves", [](Scene& s) { s.positions[3].x += 1e-6f; }},
      {"a normal turns", [](Scene& s) { s.normals[3] = -s.normals[3]; }},
      {"two indices swap", [](Scene& s) { std::swap(s.indices[0], s.indices[1]); }},
      {"a triangle takes another material", [](Scene& s) { s.draws[0].material ^= 1; }},
      {"a colour", [](Scene& s) { s.materials[0].baseColor.y *= 0.5f; }},
      {"an emission", [](Scene& s) { s.materials[0].emission.z += 1; }},
      {"a wrap", [](Scene& s) { s.materials[0].baseColorTexture.sampler.v = Wrap::Clamp; }},
      {"a texel", [](Scene& s) { s.images[0].rgba[7] = 254; }},
      {"the file's place in the world", [](Scene& s) { s.origin.x += 1; }}};
  std::set<uint64_t> seen{before};
  for (const auto& [what, edit] : edits) {
    Scene other = scene;
    edit(other);
    EXPECT_TRUE(seen.insert(surfaceContent(other)).second) << what;
  }
  Scene other = scene;
  other.lights.clear();
  other.cameras.clear();
  other.path = "another.glb";
  EXPECT_EQ(surfaceContent(other), before) << "lights, cameras and names are no surfaces";
}

class Dirty : public EffectsTest {
 protected:
  static Scene room() {
    Scene scene = furnishedRoom();
    scene.lights = {lamp(0)};
    return scene;
  }
  std::unique_ptr<Pipeline> prepared() {
    auto pipeline = std::make_unique<Pipeline>(context(), room(), settings_);
    pipeline->prepare();
    recorded();
    return pipeline;
  }
  /// Whether a stage of this name was recorded since the last call of recorded().
  bool ran(const char* stage) {
    for (const Timings::Row& row : context().timings.rows())
      if (row.stage.starts_with(stage)) return true;
    return false;
  }
  Settings settings_ = small();
};

TEST_F(Dirty, WhatIsChangedAndChangedBackCostsNothing) {
  const auto pipeline = prepared();
  const Revision before = pipeline->revision();
  const EffectPlan plan = pipeline->plan();
  Settings other = settings_;
  other.voxel.resolution = 24;
  EXPECT_EQ(pipeline->due(other), Redo::Voxels);
  EXPECT_EQ(pipeline->due(settings_), Redo::Nothing) << "due() takes nothing";
  EXPECT_EQ(pipeline->set(other), Redo::Voxels);
  EXPECT_FALSE(pipeline->current());
  EXPECT_EQ(pipeline->set(settings_), Redo::Nothing);
  EXPECT_TRUE(pipeline->asleep());
  pipeline->setLights({lamp(0.1)});
  EXPECT_FALSE(pipeline->asleep());
  pipeline->setLights({lamp(0)});
  EXPECT_TRUE(pipeline->asleep());
  const Counters work = context().counters();
  pipeline->prepare();
  EXPECT_EQ(context().counters().since(work).dispatches, 0u);
  EXPECT_EQ(context().counters().since(work).draws, 0u);
  EXPECT_EQ(pipeline->revision(), before);
  for (const EffectRow& row : pipeline->plan().rows) EXPECT_EQ(row.reason, plan.row(row.effect).reason);
}

TEST_F(Dirty, LambdaRebuildsNothingAndGathersNothing) {
  const auto pipeline = prepared();
  const uint64_t built = pipeline->revision().build;
  settings_.solver.gpu.lambda = 0.5f;
  EXPECT_EQ(pipeline->set(settings_), Redo::Solve);
  pipeline->prepare();
  EXPECT_EQ(pipeline->revision().build, built);
  EXPECT_TRUE(ran("GI Solve"));
  for (const char* stage : {"GI Voxelization", "GI CompactList", "GI SDF", "GI BuildMatrix", "GI Gather", "RE Shadow"})
    EXPECT_FALSE(ran(stage)) << stage;
}

TEST_F(Dirty, EmitterSamplesAreTakenAnewOfTheSameMatrix) {
  Scene scene = room();
  scene.materials.at(0).emission = glm::vec3(1);
  settings_.matrix.emitterSampling = EffectMode::on;
  Pipeline pipeline(context(), std::move(scene), settings_);
  pipeline.prepare();
  const uint64_t built = pipeline.revision().build;
  recorded();
  settings_.matrix.emitterSamples = 64;
  EXPECT_EQ(pipeline.set(settings_), Redo::Emission);
  pipeline.prepare();
  EXPECT_TRUE(ran("GI Solve Emitters"));
  EXPECT_EQ(pipeline.revision().build, built);
  EXPECT_TRUE(pipeline.asleep());
}

TEST_F(Dirty, ALightsColourRedrawsNoShadowMapItsPlaceDoes) {
  const auto pipeline = prepared();
  pipeline->setLights({lamp(0, 5)});
  pipeline->prepare();
  EXPECT_FALSE(ran("RE Shadow"));
  EXPECT_TRUE(ran("GI Gather"));
  recorded();
  pipeline->setLights({lamp(0.1, 5)});
  pipeline->prepare();
  EXPECT_TRUE(ran("RE Shadow"));
  EXPECT_FALSE(ran("GI BuildMatrix"));
}

// The light of maps that were kept is that of maps that were drawn for it.
TEST_F(Dirty, KeptShadowMapsGiveTheSameBits) {
  const auto picture = [&](Pipeline& pipeline) {
    std::vector<glm::vec4> pixels;
    pipeline.solvedAfresh({}, [&] { pixels = draw(pipeline); });
    return pixels;
  };
  const auto pipeline = prepared();
  const std::vector<glm::vec4> before = picture(*pipeline);
  pipeline->setLights({lamp(0, 5)});
  pipeline->prepare();
  const std::vector<glm::vec4> kept = picture(*pipeline);
  pipeline->lightsChanged();  // maps and all
  pipeline->prepare();
  EXPECT_TRUE(same(picture(*pipeline), kept));
  EXPECT_FALSE(same(kept, before));
}

TEST_F(Dirty, ASceneReadAgainKeepsWhatItsSurfacesHaveMade) {
  const auto pipeline = prepared();
  const uint64_t built = pipeline->revision().build;
  Scene again = room();
  ASSERT_TRUE(pipeline->adopt(again));
  EXPECT_TRUE(pipeline->asleep()) << "nothing has changed";
  Scene brighter = room();
  brighter.lights.push_back(lamp(0.2, 1));
  brighter.cameras.push_back(brighter.cameras.at(0));
  ASSERT_TRUE(pipeline->adopt(brighter));
  EXPECT_EQ(pipeline->scene().lights.size(), 2u);
  EXPECT_EQ(pipeline->scene().cameras.size(), room().cameras.size() + 1);
  EXPECT_FALSE(pipeline->asleep());
  pipeline->prepare();
  EXPECT_EQ(pipeline->revision().build, built);
  // A moved vertex needs a new pipeline; this one stays, and so does the scene that was read.
  Scene moved = room();
  moved.positions[0].y += 0.1f;
  EXPECT_FALSE(pipeline->adopt(moved));
  EXPECT_FALSE(moved.positions.empty());
  EXPECT_TRUE(pipeline->asleep());
  // So do wrong lights.
  Scene wrong = room();
  wrong.lights[0].intensity = -1;
  EXPECT_THROW(pipeline->adopt(wrong), UsageError);
  EXPECT_EQ(pipeline->scene().lights.size(), 2u);
  EXPECT_TRUE(pipeline->asleep());
}

TEST_F(Dirty, ARebuildThatWasCancelledOwesTheMatrixItGaveUp) {
  const auto pipeline = prepared();
  Settings other = settings_;
  other.voxel.resolution = 24;
  pipeline->set(other);
  int rows = 0;  // reports of the matrix build; the first comes before the old matrix is given up
  EXPECT_THROW(pipeline->prepare([&](const char* stage, float) {
    rows += std::string_view(stage) == "GI BuildMatrix" ? 1 : 0;
    return rows < 2;
  }),
               WorkError);
  EXPECT_EQ(pipeline->set(settings_), Redo::Matrix) << "the voxels are still there";
  recorded();
  pipeline->prepare();
  EXPECT_FALSE(ran("GI Voxelization"));
  EXPECT_TRUE(ran("GI BuildMatrix"));
  EXPECT_TRUE(pipeline->asleep());
}

}  // namespace
}  // namespace irad::test::stage_keys_suite
