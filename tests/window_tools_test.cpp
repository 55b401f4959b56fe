// What is done in the window: captures, A/B, the inspector, lights, recordings.
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "gi/views.h"
#include "renderer/scene/sidecar.h"
#include "tests/window_fixture.h"

namespace irad::test {
namespace {

using WindowToolsTest = WindowTest;

TEST_F(WindowToolsTest, CapturesReplayToTheSameBits) {
  start({"--set", "solver.tolerance=0.01", "--set", "camera.exposure=1"});
  xdotool("mousemove 360 510");
  ASSERT_TRUE(viewportSettles(lit));
  xdotool("keydown w sleep 0.3 keyup w");
  ASSERT_TRUE(viewportSettles(lit));
  const ScreenPart first = part();
  const std::filesystem::path captures = folder_.path / "out/captures";

  // The view, then all of them, each into a new folder; the window shows what it showed.
  key("F12");
  EXPECT_TRUE(says("Saved Lit to out/captures/box.001"));
  key("shift+F12");
  EXPECT_TRUE(says("views to out/captures/box.002", 180));
  std::vector<std::string> all{"manifest.json"};
  for (const ViewInfo& view : views())
    for (const char* extension : {".png", ".exr"}) all.push_back(view.name + std::string(extension));
  std::sort(all.begin(), all.end());
  for (const auto& [name, wanted] :
       {std::pair("box.001", std::vector<std::string>{"lit.exr", "lit.png", "manifest.json"}),
        std::pair("box.002", all)}) {
    auto saved = contents(captures / name);
    std::vector<std::string> names;
    for (const auto& [file, bytes] : saved) names.push_back(file);
    EXPECT_EQ(names, wanted) << name;
    const RunResult replay = runIrad(
        {"render", "--config", (captures / name / "manifest.json").string(), "--out", (folder_.path / name).string()});
    ASSERT_EQ(replay.status, 0) << replay.err;
    auto again = contents(folder_.path / name);
    for (const std::string& file : names) {
      EXPECT_TRUE(file == "manifest.json" || saved[file] == again[file]) << name << ": " << file;
    }
    // All that differs: the headless run writes its times and memory too.
    nlohmann::json ours = nlohmann::json::parse(saved["manifest.json"]),
                   theirs = nlohmann::json::parse(again["manifest.json"]);
    ours.erase("files");
    theirs.erase("files");
    EXPECT_EQ(ours, theirs);
  }
  ASSERT_TRUE(settles([this] { return part(); }, [&](const ScreenPart& p) { return p == first; }))
      << "saving changed the picture";
  key("Escape");
  EXPECT_EQ(window_->wait(20), 0) << window_->log();
}

TEST_F(WindowToolsTest, AManifestOpensWithItsViewAndCamera) {
  start({"--view", "direct"});
  xdotool("mousemove 360 510");
  ASSERT_TRUE(viewportSettles(lit));
  const ScreenPart begun = part();
  xdotool("keydown w sleep 0.3 keyup w");
  ASSERT_TRUE(settles([this] { return part(); }, [&](const ScreenPart& p) { return p.difference(begun) > 0.02; }, 30));
  const ScreenPart flown = part();
  key("F12");
  ASSERT_TRUE(says("Saved Direct light to out/captures/box.001"));
  key("Escape");
  ASSERT_EQ(window_->wait(20), 0);

  start({"--config", (folder_.path / "out/captures/box.001/manifest.json").string()});
  xdotool("mousemove 360 510");
  EXPECT_TRUE(settles([this] { return part(); }, [&](const ScreenPart& p) { return p == flown; }, 30));
  key("Escape");
  EXPECT_EQ(window_->wait(20), 0);
}

TEST_F(WindowToolsTest, CapturesThatCannotBeWrittenSayWhy) {
  std::ofstream(folder_.path / "taken") << "a file";
  start({"--out", (folder_.path / "taken").string()});
  xdotool("mousemove 360 510");
  ASSERT_TRUE(viewportSettles(lit));
  key("F12");
  EXPECT_TRUE(says("cannot create folder " + (folder_.path / "taken").string())) << window_->log();
  EXPECT_EQ(slurp(folder_.path / "taken"), "a file");
  key("Escape");
  EXPECT_EQ(window_->wait(20), 0);
}

TEST_F(WindowToolsTest, ComparesTwoSetsOfSettings) {
  fold("[]");
  start();
  xdotool("mousemove 360 510");
  ASSERT_TRUE(viewportSettles(lit));
  const auto left = [this] { return screen_->grab(400, 100, 240, 380); };
  const auto right = [this] { return screen_->grab(690, 100, 240, 380); };
  const ScreenPart a = left(), alsoA = right();
  // Compare; then one facet per voxel on side B: the lamp's light is gone there, and only there.
  xdotool("mousemove 1100 279 sleep 0.5 click 1 sleep 0.5 mousemove 360 510");
  ASSERT_TRUE(viewportSettles([&](const ScreenPart&) { return right() == alsoA; }))
      << "the same settings, two pictures";
  xdotool(
      "mousemove 205 615 sleep 0.5 click 1 sleep 0.8 mousemove 160 636 sleep 0.5 click 1 sleep 0.5 mousemove 360 510");
  ASSERT_TRUE(settles(right, [&](const ScreenPart& p) { return p.difference(alsoA) > 0.3; })) << "B is not rebuilt";
  EXPECT_EQ(left(), a) << "A is B's";
  const ScreenPart b = right();
  // Saved are both, each with what draws it again.
  key("F12");
  ASSERT_TRUE(says("Saved Lit of both sides to out/captures/box.001"));
  std::map<std::string, std::string> saved[2];
  for (const int side : {0, 1}) {
    const std::filesystem::path folder = folder_.path / "out/captures/box.001" / (side ? "b" : "a"),
                                again = folder_.path / (side ? "again.b" : "again.a");
    saved[side] = contents(folder);
    const RunResult replay =
        runIrad({"render", "--config", (folder / "manifest.json").string(), "--out", again.string()});
    ASSERT_EQ(replay.status, 0) << replay.err;
    for (const char* file : {"lit.png", "lit.exr"}) EXPECT_EQ(saved[side][file], contents(again)[file]) << folder;
  }
  EXPECT_NE(saved[0]["lit.exr"], saved[1]["lit.exr"]);
  xdotool("mousemove 830 497 sleep 0.5 click 1 sleep 0.5 mousemove 360 510");  // the message, which is in the way
  // A click takes the side that it is on: "edit A", then B, in the panel.
  const auto edits = [this](int x) {
    return settles([this, x] { return screen_->grab(x - 2, 277, 4, 4); },
                   [](const ScreenPart& p) { return p.meanLuminance() > 0.4; }, 30);
  };
  EXPECT_TRUE(edits(1088));
  xdotool("mousemove 500 440 sleep 0.5 click 1 sleep 0.5 mousemove 360 510");
  EXPECT_TRUE(edits(1047)) << "a click on A";
  xdotool("mousemove 800 400 sleep 0.5 click 1 sleep 0.5 mousemove 360 510");
  EXPECT_TRUE(edits(1088)) << "a click on B";
  xdotool("mousemove 960 300 sleep 0.5 click 1 sleep 0.5 mousemove 360 510");  // beside the scene: lets go
  // The split follows the mouse; X shows one side, then the other.
  xdotool("mousemove 666 300 sleep 0.5 mousedown 1 sleep 0.5 mousemove 950 300 sleep 0.5 mouseup 1 sleep 0.5");
  xdotool("mousemove 360 510");
  ASSERT_TRUE(settles(right, [&](const ScreenPart& p) { return p == alsoA; })) << "the split cannot be dragged";
  key("x");
  ASSERT_TRUE(settles(right, [&](const ScreenPart& p) { return p == alsoA && left() == a; })) << "X does not show A";
  key("x");
  ASSERT_TRUE(settles(right, [&](const ScreenPart& p) { return p == b && left() != a; })) << "X does not show B";
  key("Escape");
  EXPECT_EQ(window_->wait(20), 0);
}

TEST_F(WindowToolsTest, InspectsWhatIsClicked) {
  // With the other panels folded, the inspector's rows are where this test looks for them.
  fold(R"(["View", "Compare", "Solver", "Memory"])");
  start();
  xdotool("mousemove 360 510");
  ASSERT_TRUE(viewportSettles(lit));
  const ScreenPart first = part();
  const auto panel = [this] { return screen_->grab(1010, 80, 250, 580); };
  const auto click = [this](int x, int y, const char* key = "") {
    const std::string down = *key ? fmt::format("keydown {} sleep 0.2", key) : "",
                      up = *key ? fmt::format("keyup {} sleep 0.2", key) : "";
    xdotool(fmt::format("mousemove {} {} sleep 0.3 {} mousedown 1 sleep 0.2 mouseup 1 sleep 0.2 {} mousemove 360 510",
                        x, y, down, up));
  };
  const auto changes = [&](const ScreenPart& before) {
    return settles(panel, [&](const ScreenPart& p) { return p.difference(before) > 0.003; });
  };

  // A click on the floor draws the links of the facet there and fills the panel.
  const ScreenPart empty = panel();
  click(665, 490);
  ASSERT_TRUE(changes(empty)) << "nothing is picked";
  const ScreenPart picked = part(), row = panel();
  EXPECT_GT(picked.difference(first), 0.005) << "no links are drawn";
  // Its column; a filter that no voxel passes; and off again.
  click(1076, 472);
  ASSERT_TRUE(changes(row)) << "no column is shown";
  const ScreenPart column = panel();
  // Return leaves the field: a window with a blinking cursor never rests.
  const auto inFilter = [this](const std::string& keys) {
    xdotool("mousemove 1130 536 sleep 0.5 click 1 sleep 0.5 " + keys);
    xdotool("sleep 0.5 keydown Return sleep 0.5 keyup Return mousemove 360 510");
  };
  inFilter("type --delay 60 none");
  ASSERT_TRUE(changes(column)) << "the filter is not taken";
  inFilter("key --delay 60 BackSpace BackSpace BackSpace BackSpace");
  // Another facet's row beside it.
  const ScreenPart before = panel();
  click(480, 130, "shift");
  ASSERT_TRUE(changes(before)) << "no comparison";
  // A drag turns the camera and picks nothing; a click beside the scene lets go.
  click(345, 300);
  ASSERT_TRUE(settles([this] { return part(); }, [&](const ScreenPart& p) { return p == first; })) << "not let go";
  EXPECT_EQ(panel(), empty);
  xdotool("mousemove 600 300 sleep 0.3 mousedown 1 sleep 0.2 mousemove 680 320 sleep 0.2 mouseup 1 mousemove 360 510");
  ASSERT_TRUE(settles([this] { return part(); }, [&](const ScreenPart& p) { return p.difference(first) > 0.05; }));
  EXPECT_EQ(panel(), empty) << "a drag picks";
  key("Escape");
  EXPECT_EQ(window_->wait(20), 0);
}

TEST_F(WindowToolsTest, LightsAreAddedDraggedAndSavedBesideTheScene) {
  const std::filesystem::path scene = folder_.path / "a.glb", sidecar = sidecarPath(scene);
  std::filesystem::copy_file(assets() / "box.glb", scene);
  const std::string sha = sha256File(scene);
  fold(R"(["Scene", "Settings"])");
  start({}, scene);
  xdotool("mousemove 360 510");
  ASSERT_TRUE(viewportSettles(lit));
  const ScreenPart first = viewport();

  // "point": one ahead of the camera, in the middle of the picture.
  xdotool("mousemove 104 101 sleep 0.5 click 1 sleep 0.5 mousemove 360 510");
  ASSERT_TRUE(viewportSettles([&](const ScreenPart& p) { return p.difference(first) > 0.3; })) << "nothing is added";
  const ScreenPart added = viewport();
  const auto drag = [&](int fromX, int fromY, int toX, int toY) {
    xdotool(
        fmt::format("mousemove {} {} sleep 0.5 mousedown 1 sleep 0.5 mousemove {} {} sleep 0.5 mousemove {} {} "
                    "sleep 0.5 mouseup 1 sleep 0.5 mousemove 360 510",
                    fromX, fromY, (fromX + toX) / 2, (fromY + toY) / 2, toX, toY));
  };
  drag(665, 281, 565, 201);
  ASSERT_TRUE(viewportSettles([&](const ScreenPart& p) { return p != added; })) << "it is not dragged";
  EXPECT_FALSE(std::filesystem::exists(sidecar)) << "saved without being asked";
  const auto save = [&] { xdotool("mousemove 30 384 sleep 0.5 click 1 sleep 0.5 mousemove 360 510"); };
  save();
  ASSERT_TRUE(says("Saved lights and bookmarks to " + sidecar.string()));
  const Sidecar kept = readSidecar(sidecar);
  ASSERT_TRUE(kept.lights);
  ASSERT_EQ(kept.lights->size(), 2u);
  const Scene own = loadScene(scene);
  EXPECT_EQ(kept.lights->at(0), own.lights.at(0));
  // In the plane of the view: 100 pixels to the left, 80 up.
  const Light& point = kept.lights->at(1);
  EXPECT_EQ(point.type, LightType::Point);
  const glm::dvec3 moved =
      glm::inverse(glm::dquat(own.cameras[0].orientation)) * (point.position - own.cameras[0].position);
  EXPECT_LT(moved.z, 0);
  EXPECT_NEAR(moved.x / moved.y, -100.0 / 80.0, 0.02);
  const double pixel = 2 * -moved.z * std::tan(own.cameras[0].yfov / 2) / 502;  // the viewport's height
  EXPECT_NEAR(moved.x / pixel, -100, 2);

  // Where it cannot be saved: said, and nothing is lost.
  std::filesystem::remove(sidecar);
  std::filesystem::create_directory(sidecar);
  drag(565, 201, 700, 300);
  save();
  EXPECT_TRUE(says("Lights and bookmarks stay in this window, unsaved"));
  std::filesystem::remove(sidecar);
  save();
  for (int i = 0; i < 100 && !std::filesystem::exists(sidecar); ++i) pause(0.1);
  EXPECT_GT(readSidecar(sidecar).lights->at(1).position.x, own.cameras[0].position.x);
  key("Escape");
  EXPECT_EQ(window_->wait(20), 0) << "status after Esc, with validation on";
  EXPECT_EQ(sha256File(scene), sha) << "the scene's file was written to";

  start({}, scene);
  EXPECT_TRUE(says("lights of a.glb.irad.json"));
  key("Escape");
  EXPECT_EQ(window_->wait(60), 0);
}

TEST_F(WindowToolsTest, TheMenuCapturesAFrameWithRenderDoc) {
  environment_["LD_PRELOAD"] = RENDERDOC_STAND_IN;
  start();
  xdotool("mousemove 360 510");
  ASSERT_TRUE(viewportSettles(lit));
  // File, Capture a frame with RenderDoc.
  xdotool("mousemove 22 15 sleep 0.5 click 1 sleep 0.5 mousemove 80 157 sleep 0.5 click 1 sleep 0.5 mousemove 360 510");
  EXPECT_TRUE(says("RenderDoc saved out/captures/box_capture.rdc")) << window_->log();
  EXPECT_EQ(slurp(folder_.path / "out/captures/box_capture.rdc"), "RDOC");
  ASSERT_TRUE(viewportSettles(lit)) << "no picture after the capture";
  key("Escape");
  EXPECT_EQ(window_->wait(20), 0);
}

TEST_F(WindowToolsTest, RecordsFramesWhileItIsAskedTo) {
  start({"--out", (folder_.path / "out").string()});
  xdotool("mousemove 360 510");
  ASSERT_TRUE(viewportSettles(lit));
  // "Record" at the right end of the strip's tabs; the same button ends it.
  const auto press = [this](int x, int y) {
    xdotool(fmt::format("mousemove {} {} sleep 0.3 mousedown 1 sleep 0.3 mouseup 1 sleep 0.3", x, y));
  };
  press(930, 552);
  pause(2);
  press(930, 552);
  ASSERT_TRUE(says("Recorded ")) << window_->log();
  const auto files = contents(folder_.path / "out" / "recording.001");
  ASSERT_EQ(files.size(), 3u);
  const auto trace = nlohmann::json::parse(files.at("trace.json"));
  const auto pictures = [&](const char* stage) {
    return std::count_if(trace["traceEvents"].begin(), trace["traceEvents"].end(),
                         [&](const auto& event) { return event["name"] == stage; });
  };
  EXPECT_GE(pictures("frame"), 3) << "pictures do not follow each other while it records";
  EXPECT_GE(pictures("RE Forward"), 3);
  EXPECT_TRUE(files.at("frames.csv").starts_with("frame,kind,began_ms,cpu_ms,"));
  // It sleeps again.
  xdotool("mousemove 360 510");
  ASSERT_TRUE(viewportSettles(lit));
  key("Escape");
  EXPECT_EQ(window_->wait(20), 0);
}

}  // namespace
}  // namespace irad::test
