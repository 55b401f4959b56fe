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

/// The stages that are due, by name.
std::string due(const StagesDue& stages) {
  std::string names;
  for (uint32_t stage = 0; stage < static_cast<uint32_t>(Redo::Shade); ++stage)
    if (stages.has(Redo{stage})) names += fmt::format("{} ", nameOf(Redo{stage}));
  return names;
}

TEST(StageKeys, MaterialsAndRaysDoNotReadEachOther) {
  const Settings s = defaultSettings(true);
  SceneContent content{1, 2, 3, 4, 5};
  const StageKeys keys = stageKeys(content, s);
  const auto dueWith = [&](const SceneContent& other) { return due(StagesDue(keys, stageKeys(other, s))); };
  EXPECT_EQ(dueWith(content), "");
  EXPECT_EQ(dueWith({9, 2, 3, 4, 5}), "voxels field matrix materials emission gather solve scatter ");
  EXPECT_EQ(dueWith({1, 9, 3, 4, 5}), "gather solve scatter ");
  EXPECT_EQ(dueWith({1, 2, 9, 4, 5}), "gather solve scatter ");
  EXPECT_EQ(dueWith({1, 2, 3, 9, 5}), "materials solve scatter ");
  EXPECT_EQ(dueWith({1, 2, 3, 9, 9}), "materials emission solve scatter ");
  Settings other = s;
  other.matrix.gpu.seed = 7;
  EXPECT_EQ(due(StagesDue(keys, stageKeys(content, other))), "matrix emission gather solve scatter ");
  // What is forgotten is due, with all that comes of it and nothing else.
  const auto without = [&](Redo stage) {
    StageKeys forgotten = keys;
    forgotten.forget(stage);
    return due(StagesDue(forgotten, keys));
  };
  EXPECT_EQ(without(Redo::Voxels), "voxels field matrix materials emission gather solve scatter ");
  EXPECT_EQ(without(Redo::Matrix), "matrix emission gather solve scatter ");
  EXPECT_EQ(without(Redo::Materials), "materials solve scatter ");
  EXPECT_EQ(without(Redo::Emission), "emission solve scatter ");
  EXPECT_EQ(without(Redo::Gather), "gather solve scatter ");
  EXPECT_EQ(without(Redo::Scatter), "scatter ");
  EXPECT_EQ(due(StagesDue::from(Redo::Gather)), "gather solve scatter ");
}

/// The keys of a scene's surfaces, materials and what emits, by a letter for each that differs.
std::string differing(const Scene& a, const Scene& b) {
  const SurfaceContent of(a), its(b);
  return std::string(of.surfaces(a.materials) != its.surfaces(b.materials) ? "s" : "") +
         (of.materials(a.materials) != its.materials(b.materials) ? "m" : "") +
         (of.emission(a.materials) != its.emission(b.materials) ? "e" : "");
}

TEST(SurfaceContent, TellsWhatMovesSurfacesFromWhatColoursThem) {
  Scene scene = furnishedRoom();
  scene.images.push_back({"checks", 2, 2, true, std::vector<uint8_t>(16, 255)});
  scene.materials[0].baseColorTexture.image = 0;
  EXPECT_EQ(differing(scene, Scene(scene)), "");
  struct Change {
    const char* what;
    const char* differs;
    std::function<void(Scene&)> make;
  };
  const auto masked = [](Scene& s) { s.materials[0].alpha = AlphaMode::Mask; };
  for (const Change& change : std::vector<Change>{
           {"a vertex moves", "s", [](Scene& s) { s.positions[3].x += 1e-6f; }},
           {"a normal turns", "s", [](Scene& s) { s.normals[3] = -s.normals[3]; }},
           {"two indices swap", "s", [](Scene& s) { std::swap(s.indices[0], s.indices[1]); }},
           {"a triangle takes another material", "s", [](Scene& s) { s.draws[0].material ^= 1; }},
           {"the file's place in the world", "s", [](Scene& s) { s.origin.x += 1; }},
           {"a back shows", "sm", [](Scene& s) { s.materials[0].doubleSided = true; }},
           {"a mask", "sm", masked},
           {"a cutoff that nothing asks for", "m", [](Scene& s) { s.materials[0].alphaCutoff = 0.25f; }},
           {"a colour", "m", [](Scene& s) { s.materials[0].baseColor.y *= 0.5f; }},
           {"an alpha", "m", [](Scene& s) { s.materials[0].baseColor.a *= 0.5f; }},
           {"a roughness", "m", [](Scene& s) { s.materials[0].roughness = 0.375f; }},
           {"a metalness", "m", [](Scene& s) { s.materials[0].metallic = 0.375f; }},
           {"no texture", "m", [](Scene& s) { s.materials[0].baseColorTexture.image = -1; }},
           {"a wrap", "m", [](Scene& s) { s.materials[0].baseColorTexture.sampler.v = Wrap::Clamp; }},
           {"a texel", "m", [](Scene& s) { s.images[0].rgba[7] = 254; }},
           {"an emission", "me", [](Scene& s) { s.materials[0].emission.z += 1; }},
           {"an emission texture that nothing emits by", "m",
            [](Scene& s) { s.materials[0].emissiveTexture.image = 0; }},
           {"lights, cameras and names", "",
            [](Scene& s) { s.lights.clear(), s.cameras.clear(), s.path = "b.glb"; }}}) {
    Scene other = scene;
    change.make(other);
    EXPECT_EQ(differing(scene, other), change.differs) << change.what;
  }
  // Of panes the colour is where surfaces are, too: what passes is cut out of them.
  Scene pane = scene;
  pane.materials[0].transmission = 0.5f;
  EXPECT_EQ(differing(scene, pane), "sm");
  Scene other = pane;
  other.materials[0].baseColor.y *= 0.5f;
  EXPECT_EQ(differing(pane, other), "sm");
  // With a mask alpha and what it comes of are where surfaces are.
  Scene cut = scene;
  masked(cut);
  cut.materials[1].emission = glm::vec3(1);
  cut.materials[1].emissiveTexture.image = 0;
  for (const Change& change : std::vector<Change>{
           {"a cutoff", "sm", [](Scene& s) { s.materials[0].alphaCutoff = 0.25f; }},
           {"an alpha", "sm", [](Scene& s) { s.materials[0].baseColor.a *= 0.5f; }},
           {"no texture", "sm", [](Scene& s) { s.materials[0].baseColorTexture.image = -1; }},
           {"a texel", "sme", [](Scene& s) { s.images[0].rgba[7] = 254; }},
           {"a colour", "m", [](Scene& s) { s.materials[0].baseColor.y *= 0.5f; }},
           {"an emission that moves on", "me",
            [](Scene& s) { std::swap(s.materials[0].emission, s.materials[1].emission); }},
           {"no emission texture", "me", [](Scene& s) { s.materials[1].emissiveTexture.image = -1; }}}) {
    Scene other = cut;
    change.make(other);
    EXPECT_EQ(differing(cut, other), change.differs) << change.what;
  }
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
