// Undo and redo by themselves: which frames are one step, what a step is called, what it brings back.
#include <gtest/gtest.h>

#if IRAD_UI

#include "gi/picture.h"
#include "gi/stage_keys.h"
#include "renderer/scene/sky_image.h"
#include "ui/history.h"

namespace irad::test::history_suite {
namespace {

struct HistoryTest : ::testing::Test {
  History history;
  EditState now;
  void SetUp() override {
    now.camera.name = "main";
    see();
  }
  void see(bool held = false) { history.see(now, held); }
  std::vector<std::string> names() const {
    std::vector<std::string> out;
    for (const History::Step& step : history.steps()) out.push_back(step.name);
    return out;
  }
  std::string last() const { return history.steps().back().name; }
  void undo() { now = history.go(history.at() - 1); }
  void redo() { now = history.go(history.at() + 1); }
  void fly(double x) {
    now.camera.position.x = x;
    see(/*held=*/true);
    now.camera.position.x = x + 1;
    see(/*held=*/true);
    see();
  }
  using Names = std::vector<std::string>;
};

TEST_F(HistoryTest, ADragOrATypedWordIsOneStep) {
  EXPECT_FALSE(history.canUndo());
  const EditState before = now;
  for (const uint32_t rays : {130u, 140u, 150u}) {
    now.a.settings.matrix.gpu.rays = rays;
    see(/*held=*/true);
  }
  EXPECT_EQ(history.steps().size(), 1u) << "before it is let go";
  see();
  see();
  EXPECT_EQ(names(), (Names{"the beginning", "matrix.rays 128 to 150"}));
  const EditState dragged = now;
  undo();
  EXPECT_EQ(now, before);
  see();
  EXPECT_FALSE(history.canUndo());
  redo();
  EXPECT_EQ(now, dragged);
  see();
  EXPECT_FALSE(history.canRedo());
  // Dragged away and back again: nothing.
  now.a.settings.matrix.gpu.rays = 10;
  see(/*held=*/true);
  now.a.settings.matrix.gpu.rays = 150;
  see(/*held=*/true);
  see();
  EXPECT_EQ(history.steps().size(), 2u);
  // Another edit after an undo takes the place of what was undone.
  undo();
  see();
  now.a.settings.voxel.resolution = 32;
  see();
  EXPECT_EQ(names(), (Names{"the beginning", "voxel.resolution 64 to 32"}));
}

/// Every setting: the same stages forth and back, and none once it is back.
TEST_F(HistoryTest, UndoRedoesNoMoreStagesThanTheSettingDid) {
  const Settings original = now.a.settings;
  size_t counted = 0;
  for (const Setting& setting : settingTable()) {
    if (std::string_view(setting.name) == "view.facet") continue;  // a pick, which is no edit
    const double value = setting.get(original);
    double other = value != setting.range.min ? setting.range.min : setting.range.max;
    if (setting.kind == SettingKind::toggle) other = 1 - value;
    if (setting.kind == SettingKind::choice)
      other = value + 1 < static_cast<double>(setting.choices.size()) ? value + 1 : 0;
    setting.set(now.a.settings, other);
    see();
    const Settings edited = now.a.settings;
    ASSERT_TRUE(last().starts_with(setting.name)) << last();
    undo();
    see();
    EXPECT_EQ(firstDifference(edited, now.a.settings), firstDifference(original, edited)) << setting.name;
    EXPECT_EQ(firstDifference(original, now.a.settings), Redo::Nothing) << setting.name;
    EXPECT_EQ(now.a.settings, original) << setting.name;
    redo();
    EXPECT_EQ(now.a.settings, edited) << setting.name;
    undo();
    see();
    ++counted;
  }
  EXPECT_EQ(counted, settingTable().size() - 1);
}

TEST_F(HistoryTest, PicturesOfTheSkyAndReferencesAreSteps) {
  SkyImage sky;
  sky.path = "/skies/evening.hdr";
  ReferencePicture reference;
  reference.path = "/truth.exr";
  now.sky = std::make_shared<const SkyImage>(sky);
  see();
  now.reference = std::make_shared<const ReferencePicture>(reference);
  see();
  now.sky.reset();
  see();
  EXPECT_EQ(names(), (Names{"the beginning", "picture of the sky evening.hdr", "reference truth.exr",
                            "without picture of the sky evening.hdr"}));
  undo();
  EXPECT_EQ(now.sky->path, sky.path);
  undo();
  EXPECT_EQ(now.reference, nullptr);
}

TEST_F(HistoryTest, FlightsAreOneStepAndDoNotDrownTheRest) {
  fly(1);
  fly(5);
  fly(9);
  EXPECT_EQ(names(), (Names{"the beginning", "flight"}));
  now.a.settings.matrix.gpu.rays = 7;
  see();
  fly(20);
  fly(30);
  EXPECT_EQ(names(), (Names{"the beginning", "flight", "matrix.rays 128 to 7", "flight"}));
  undo();
  EXPECT_EQ(now.camera.position.x, 10);
  EXPECT_EQ(now.a.settings.matrix.gpu.rays, 7u);
  see();
  redo();
  see();
  // A camera that is chosen is a step of its own.
  now.camera = {.name = "door"};
  now.sceneCamera = 1;
  see();
  EXPECT_EQ(last(), "camera door");
  fly(3);
  EXPECT_EQ(last(), "flight");
  // Back where the flight began: no step.
  now.camera.position.x = 0;
  see();
  EXPECT_EQ(last(), "camera door");
}

TEST_F(HistoryTest, LookingAroundKeepsWhatMayBeRedone) {
  now.a.settings.matrix.gpu.rays = 7;
  see();
  undo();
  see();
  fly(3);
  now.view = VIEW_DIRECT;
  see();
  ASSERT_TRUE(history.canRedo());
  redo();
  EXPECT_EQ(now.a.settings.matrix.gpu.rays, 7u);
  EXPECT_EQ(now.camera.position.x, 4) << "redo of a setting moves the camera";
  EXPECT_EQ(now.view, VIEW_DIRECT);
}

TEST_F(HistoryTest, WhatWasGivenUpIsAStepBack) {
  now.a.settings.voxel.resolution = 128;
  see();
  now.camera.position.x = 5;  // meanwhile
  now.a.settings.voxel.resolution = 64;
  history.seeReturned(now);
  EXPECT_EQ(history.at(), 0u);
  ASSERT_TRUE(history.canRedo());
  see();
  EXPECT_TRUE(history.canRedo()) << "the flight has become a step";
  redo();
  EXPECT_EQ(now.a.settings.voxel.resolution, 128u);
  // Nothing was returned: nothing happens.
  see();
  history.seeReturned(now);
  EXPECT_EQ(history.at(), 1u);
  // To a state that never was: a step.
  now.a.settings.voxel.resolution = 50;
  history.seeReturned(now);
  EXPECT_EQ(last(), "voxel.resolution 128 to 50");
}

TEST_F(HistoryTest, StepsSayWhatTheyAre) {
  const Light lamp{.name = "lamp", .type = LightType::Point}, sun{.name = "sun"};
  const auto step = [&](const std::string& name) {
    see();
    EXPECT_EQ(last(), name);
  };
  now.edits.lights = {sun};
  step("add light sun");
  now.edits.lights->push_back(lamp);
  step("add light lamp");
  now.edits.lights->at(1).position.x = 3;
  now.edits.lights->at(1).intensity = 4;
  step("light lamp: position, intensity");
  now.edits.lights->at(1).on = false;
  step("light lamp: off");
  now.edits.lights->erase(now.edits.lights->begin());
  step("remove light sun");
  now.edits.lights = {sun, sun};
  step("lights");
  // A new bookmark is also the camera that is chosen.
  now.edits.bookmarks.push_back({.name = "door"});
  now.sceneCamera = 1;
  step("add bookmark door");
  now.edits.bookmarks[0].yfov = 0.5f;
  step("bookmark door: place");
  now.edits.bookmarks[0].name = "gate";
  step("bookmark gate: name");
  // A material's first edit, a further one of two, and the file's own again.
  now.edits.materials = {{.material = "wall", .roughness = 0.5f}};
  step("material wall");
  now.edits.materials[0].metallic = 1.0f;
  now.edits.materials.push_back({.material = "window", .texturesOff = 1});
  step("material wall and 1 more");
  now.edits.materials.erase(now.edits.materials.begin());
  step("material wall");
  // Objects by their own names.
  now.edits.hidden.paths = {"hall/a\\/b", "hall/table/leg"};
  step("hide a\\/b and 1 more");
  now.edits.hidden.paths = {"hall/table/leg"};
  step("show a\\/b");
  now.edits.hidden = {{}, "hall/table"};
  step("isolate table");
  now.edits.hidden = {{"lamp"}, ""};
  step("end of isolation");
  now.edits.hidden = {};
  step("show all objects");
  now.view = VIEW_DIRECT;
  step(std::string("view ") + viewInfo(VIEW_DIRECT)->label);
  now.a.settings.voxel.resolution = 32;
  now.a.settings.matrix.gpu.rays = 16;
  now.a.settings.sample.emitterRays = 1;
  step("voxel.resolution 64 to 32 and 2 more");
  // As it is called, and only that one.
  history.call("preset fast");
  now.a.settings.voxel.resolution = 48;
  step("preset fast");
  history.call("preset fast");
  see();  // it changes nothing
  now.a.settings.voxel.resolution = 40;
  step("voxel.resolution 48 to 40");
}

TEST_F(HistoryTest, WhatWasSavedComesBackAndIsNoStep) {
  now.a.settings.matrix.gpu.rays = 7;
  now.a.saved = now.a.settings;  // a preset
  see();
  undo();
  EXPECT_EQ(now.a.saved, Settings()) << "an undone preset counts as unsaved";
  see();
  now.a.saved.matrix.gpu.rays = 128;
  see();
  EXPECT_EQ(history.steps().size(), 2u);
}

TEST_F(HistoryTest, AComparisonKeepsTheHistoryOfTheSideThatStays) {
  now.a.settings.matrix.gpu.rays = 7;
  see();
  for (const bool keepsB : {false, true}) {
    History begun = history;
    EditState state = now;
    const auto look = [&] { begun.see(state, /*held=*/false); };
    state.b = state.a;
    look();
    EXPECT_EQ(begun.steps().size(), 2u) << "the comparison is no step";
    state.b->settings.voxel.resolution = 32;
    look();
    EXPECT_EQ(begun.steps().back().name, "B: voxel.resolution 64 to 32");
    state.a.settings.voxel.resolution = 48;
    look();
    EXPECT_EQ(begun.steps().back().name, "A: voxel.resolution 64 to 48");
    if (keepsB) state.a = *state.b;
    state.b.reset();
    look();
    ASSERT_EQ(begun.steps().size(), 3u);
    EXPECT_EQ(begun.at(), 2u);
    EXPECT_EQ(begun.steps()[2].state.a.settings.voxel.resolution, keepsB ? 32u : 48u);
    EXPECT_EQ(begun.go(1).a.settings.voxel.resolution, 64u);
    EXPECT_EQ(begun.go(0).a.settings.matrix.gpu.rays, 128u);
  }
}

TEST_F(HistoryTest, TheOldestStepsGoFirst) {
  for (uint32_t i = 1; i <= History::kMost + 5; ++i) {
    now.a.settings.matrix.gpu.rays = 1000 + i;
    see();
  }
  EXPECT_EQ(history.steps().size(), History::kMost + 1);
  EXPECT_EQ(history.at(), History::kMost);
  EXPECT_EQ(history.go(0).a.settings.matrix.gpu.rays, 1005u);
}

}  // namespace
}  // namespace irad::test::history_suite

#else

TEST(History, NotBuilt) {
  GTEST_SKIP() << "built without IRAD_UI";
}

#endif
