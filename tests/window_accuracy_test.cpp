// The panel Accuracy: a study's front whose points give their settings, a reference that is traced meanwhile.
#include <nlohmann/json.hpp>

#include "gi/check/path_tracer.h"
#include "gi/settings.h"
#include "gi/study/results.h"
#include "renderer/base/image_io.h"
#include "renderer/base/output_file.h"
#include "renderer/scene/camera_json.h"
#include "tests/window_fixture.h"
#include "ui/panel.h"

namespace irad::test::window_accuracy_suite {
namespace {

class WindowAccuracy : public WindowTest {
 protected:
  void SetUp() override {
    WindowTest::SetUp();
    windowSize_ = "1000x560";  // with its strip folded the picture is high
    if (IsSkipped()) return;
    std::vector<std::string> folded;
    for (const auto& panel : makePanels())
      if (panel->title() != std::string("Accuracy")) folded.emplace_back(panel->title());
    fold(nlohmann::json(folded).dump().c_str());
  }
  /// Three resolutions up to that of start(), each better and dearer than the one before.
  void makeStudy(const nlohmann::ordered_json& more = nlohmann::ordered_json::object()) const {
    Settings base = defaultSettings(/*cpuDevice=*/true);
    base.voxel.resolution = 16, base.matrix.gpu.rays = 16, base.specular.mode = SpecularMode::off;
    nlohmann::ordered_json identity{{"study", "cost"}, {"scene", "box.glb"}, {"view", "indirect"}};
    identity["sweeps"] = GridTexts{{"voxel.resolution=8,12,16"}};
    identity["settings"] = nlohmann::ordered_json::parse(settingsToJson(base));
    identity.update(more);
    StudyFolder study(folder_.path / "out/study", identity.dump());
    for (size_t point = 0; point < 3; ++point) {
      const double error = .04 / std::pow(2, point), ms = 10 * std::pow(2, point);
      for (uint32_t seed = 0; seed < 2; ++seed)
        study.results.errors.push_back(
            {point, seed, error * (1 + .01 * seed), .1, 0, 30, .05, 1000, 20000, 1, 20 + ms});
      for (const char* kind : {"setup", "cold", "relight", "camera"})
        study.results.times.push_back({point, 0, kind, "GI Solve", ms});
    }
    study.save();
  }
  /// voxel.resolution of the settings as they are: of a capture's manifest.
  uint32_t resolution() {
    const std::string folder = fmt::format("out/captures/box.{:03}", ++captures_);
    key("F12");
    EXPECT_TRUE(says(folder)) << window_->log();
    const auto manifest = nlohmann::json::parse(slurp(folder_.path / folder / "manifest.json"));
    return manifest.at("settings").at("voxel.resolution").get<uint32_t>();
  }

 private:
  int captures_ = 0;
};

TEST_F(WindowAccuracy, AClickOnAPointTakesItsSettingsAndTheyComeBack) {
  makeStudy();
  start();
  rests();
  ASSERT_TRUE(appears("Accuracy/point 1")) << "the study in out/study is not read";
  EXPECT_EQ(resolution(), 16u);
  EXPECT_FALSE(has("Accuracy/Back to the settings before"));
  click("Accuracy/point 1");
  rests();
  EXPECT_EQ(resolution(), 12u);
  choose("Accuracy/cost", "memory");
  click("Accuracy/point 0");
  rests();
  EXPECT_EQ(resolution(), 8u);
  click("Accuracy/Back to the settings before");
  rests();
  EXPECT_EQ(resolution(), 12u);
  // A folder that holds no study is said to be none.
  enter("Accuracy/study", "nowhere");
  EXPECT_TRUE(appears("Accuracy/point 1", /*wanted=*/false));
  quit();  // the settings are those of the last capture
}

TEST_F(WindowAccuracy, AStudyOfAnotherCameraIsNotUsedUntilTheWindowStandsThere) {
  Camera camera;
  camera.position = {0, 1, 3};
  makeStudy({{"camera", nlohmann::ordered_json::parse(cameraToJson(camera))}, {"size", {320, 240}}});
  start();
  rests();
  ASSERT_TRUE(appears("Accuracy/Go to its camera"));
  EXPECT_FALSE(has("Accuracy/point 1"));
  click("Accuracy/Go to its camera");
  ASSERT_TRUE(appears("Accuracy/point 1"));
  EXPECT_FALSE(has("Accuracy/Go to its camera"));
  // Pictures of another size: what grows with them is no choice.
  click("Accuracy/cost");
  EXPECT_TRUE(appears("Accuracy/cost/relight"));
  EXPECT_FALSE(has("Accuracy/cost/memory") || has("Accuracy/cost/frame"));
  key("Escape");
  quit();
}

TEST_F(WindowAccuracy, AReferenceIsTracedMeasuredAndCancelled) {
  if (!hasPathTracer()) GTEST_SKIP() << "built without IRAD_EMBREE";
  start();
  rests();
  EXPECT_FALSE(has("Accuracy/flip")) << "figures without a reference";
  choose("Accuracy/samples", "4096");
  const auto pressed = [&](const std::string& name) {  // it does not come to rest while it traces
    const Control c = control(name);
    mouse().tap(fmt::format("{} {}", c.area.x + c.area.width / 2, c.area.y + c.area.height / 2));
  };
  pressed("Accuracy/Compute a reference");
  ASSERT_TRUE(appears("Accuracy/cancel reference"));
  // It is traced at the lowest priority: as long as other tests compute, hardly at all.
  ASSERT_TRUE(appears("Accuracy/flip", true, 300)) << "no figures against the first samples";
  EXPECT_TRUE(has("Accuracy/cancel reference")) << "4096 samples in no time";
  pressed("Accuracy/cancel reference");
  ASSERT_TRUE(appears("Accuracy/Compute a reference")) << "not cancelled";
  rests();
  EXPECT_TRUE(has("Accuracy/flip")) << "what there was of it is gone";
  const std::string saved = std::string("out/reference") + linearExtension();
  click("Accuracy/save reference");
  ASSERT_TRUE(says("wrote " + saved)) << window_->log();

  // Where picture and reference differ, and both beside each other.
  key("4");
  act("mousemove 1500 900");
  rests();
  const ScreenPart indirect = viewport();
  choose("Accuracy/show", "heat map");
  act("mousemove 1500 900");
  rests();
  EXPECT_GT(viewport().difference(indirect), 0.05) << "no heat map";
  choose("Accuracy/show", "split");
  act("mousemove 1500 900");
  rests();
  const ScreenPart split = viewport();
  const auto apart = [&](int from, int to) {
    double sum = 0;
    const int top = split.height / 4, bottom = split.height - split.height / 4;
    for (int y = top; y < bottom; ++y)
      for (int x = from; x < to; ++x) sum += std::abs(int{split.at(x, y, 0)} - int{indirect.at(x, y, 0)});
    return sum / ((bottom - top) * (to - from));
  };
  // The line is in the middle of the viewport, of which this part begins 68 pixels from the left.
  const int line = picture().width / 2 - 68;
  EXPECT_EQ(apart(0, line - 15), 0) << "the left half is the picture";
  EXPECT_GT(apart(line + 15, split.width), 1) << "the right half is the reference, of few samples";

  // It is of this camera alone.
  act("keydown w sleep 0.3 keyup w");
  rests();
  EXPECT_TRUE(appears("Accuracy/flip", /*wanted=*/false)) << "figures against another camera's reference";
  quit();

  // What was saved is a reference like any other, of the camera that it was made from.
  start({"--reference", (folder_.path / saved).string()});
  ASSERT_TRUE(appears("Accuracy/flip")) << "no figures against the file";
  EXPECT_FALSE(has("Accuracy/save reference"));
  if (std::string(linearExtension()) == ".exr") {
    act("keydown w sleep 0.3 keyup w");
    rests();
    EXPECT_TRUE(appears("Accuracy/flip", /*wanted=*/false)) << "figures against another camera's file";
  }
  quit();
}

}  // namespace
}  // namespace irad::test::window_accuracy_suite
