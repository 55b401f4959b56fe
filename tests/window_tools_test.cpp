// What is done in the window: captures, A/B, the inspector, lights, recordings.
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "gi/manifest.h"
#include "gi/views/views.h"
#include "renderer/base/sha256.h"
#include "renderer/scene/sidecar.h"
#include "tests/window_fixture.h"

namespace irad::test::window_tools_suite {
namespace {

class WindowToolsTest : public WindowTest {
 protected:
  void SetUp() override {
    WindowTest::SetUp();
    if (!IsSkipped()) foldPanels();
  }
};

TEST_F(WindowToolsTest, CapturesReplayToTheSameBits) {
  start({"--set", "solver.tolerance=0.01", "--set", "camera.exposure=1"});
  goAside();
  ASSERT_TRUE(viewportSettles(lit));
  act("keydown w sleep 0.3 keyup w");
  ASSERT_TRUE(viewportSettles(lit));
  const ScreenPart first = part();
  const std::filesystem::path captures = folder_.path / "out/captures";

  // The view, then all of them, each into a new folder; the window shows what it showed.
  key("F12");
  EXPECT_TRUE(says("Saved Lit to " + (captures / "box.001").string()));
  key("shift+F12");
  EXPECT_TRUE(says("views to " + (captures / "box.002").string(), 180));
  std::vector<std::string> all{"manifest.json"};
  for (const ViewInfo& view : views())
    if (!view.isFrom(FROM_PICTURE | FROM_ORACLE))  // of which there are none here
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
    // Captures say when they were made; what makes them again makes the same bytes at any time.
    EXPECT_TRUE(timeFromText(ours["time"]).has_value()) << ours["time"];
    EXPECT_FALSE(theirs.contains("time"));
    ours.erase("time");
    ours.erase("files");
    theirs.erase("files");
    EXPECT_EQ(ours, theirs);
  }
  ASSERT_TRUE(settles([this] { return part(); }, [&](const ScreenPart& p) { return p == first; }))
      << "saving changed the picture";
  quit();
}

TEST_F(WindowToolsTest, AManifestOpensWithItsViewAndCamera) {
  start({"--view", "direct"});
  goAside();
  ASSERT_TRUE(viewportSettles(lit));
  const ScreenPart begun = part();
  act("keydown w sleep 0.3 keyup w");
  ASSERT_TRUE(settles([this] { return part(); }, [&](const ScreenPart& p) { return p.difference(begun) > 0.02; }, 30));
  const ScreenPart flown = part();
  key("F12");
  ASSERT_TRUE(says("Saved Direct light to " + (folder_.path / "out/captures/box.001").string()));
  quit();

  start({"--config", (folder_.path / "out/captures/box.001/manifest.json").string()});
  goAside();
  EXPECT_TRUE(settles([this] { return part(); }, [&](const ScreenPart& p) { return p == flown; }, 30));
  quit();
}

TEST_F(WindowToolsTest, CapturesThatCannotBeWrittenSayWhy) {
  std::ofstream(folder_.path / "taken") << "a file";
  start({"--out", (folder_.path / "taken").string()});
  goAside();
  ASSERT_TRUE(viewportSettles(lit));
  key("F12");
  EXPECT_TRUE(says("cannot create folder " + (folder_.path / "taken").string())) << window_->log();
  EXPECT_EQ(slurp(folder_.path / "taken"), "a file");
  quit();
}

TEST_F(WindowToolsTest, ComparesTwoSetsOfSettings) {
  fold("[]");
  start();
  goAside();
  ASSERT_TRUE(viewportSettles(lit));
  // Below the sides' names.
  const auto left = [this] { return around(-528, -300, 477, 645); };
  const auto right = [this] { return around(50, -300, 477, 645); };
  const ScreenPart a = left(), alsoA = right();
  // Compare; then no emission on side B: the lamp's light is gone there, and only there.
  click("Compare/Compare with these settings");
  away();
  ASSERT_TRUE(viewportSettles([&](const ScreenPart&) { return right() == alsoA; }))
      << "the same settings, two pictures";
  choose("Effects/emission", "off");
  away();
  ASSERT_TRUE(settles(right, [&](const ScreenPart& p) { return p.difference(alsoA) > 0.3; })) << "B is not rebuilt";
  EXPECT_TRUE(has("Settings/side B") && has("Effects/side B")) << "panels do not say whose settings they edit";
  // The status line is above, where the mouse is low in the picture: the sides' names are below it.
  const std::vector<Control> all = controls();
  const auto status = std::ranges::find_if(all, [](const Control& c) { return c.name.starts_with("Pointing/pixel="); });
  ASSERT_NE(status, all.end());
  EXPECT_LT(status->area.y, picture().y + 50);
  EXPECT_GE(control("side=A").area.y, status->area.bottom()) << "the status line covers them";
  EXPECT_EQ(left(), a) << "A is B's";
  const ScreenPart b = right();
  // Both are saved, each with the manifest that draws it again.
  key("F12");
  ASSERT_TRUE(says("Saved Lit of both sides to " + (folder_.path / "out/captures/box.001").string()));
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
  while (has("messages/0/dismiss")) click("messages/0/dismiss");  // they are in the way
  away();
  // A click takes the side that it is on: "edit A", then B, in the panel.
  const auto edits = [this](const char* side) {
    rests();
    return isOn(std::string("Compare/edit ") + side);
  };
  EXPECT_TRUE(edits("B"));
  press(at(-329, 315));
  away();
  EXPECT_TRUE(edits("A")) << "a click on A";
  EXPECT_TRUE(has("Settings/side A"));
  press(at(267, 235));
  away();
  EXPECT_TRUE(edits("B")) << "a click on B";
  press(at(585, 37));  // beside the scene: lets go
  away();
  // The split follows the mouse; X shows one side, then the other.
  mouse().dragThrough({at(0, 37), at(560, 37)});
  goAside();
  ASSERT_TRUE(settles(right, [&](const ScreenPart& p) { return p == alsoA; })) << "the split cannot be dragged";
  key("x");
  ASSERT_TRUE(settles(right, [&](const ScreenPart& p) { return p == alsoA && left() == a; })) << "X does not show A";
  key("x");
  ASSERT_TRUE(settles(right, [&](const ScreenPart& p) { return p == b && left() != a; })) << "X does not show B";
  EXPECT_FALSE(has("legend"));
  click("Compare/show B - A");
  EXPECT_TRUE(appears("legend")) << "the colours of the difference are not explained";
  quit();
}

TEST_F(WindowToolsTest, InspectsWhatIsClicked) {
  detail_ = "32";  // rays enough for links in the upper half of the picture
  fold(R"(["Accuracy", "View", "Compare", "Solver", "Memory"])");  // the inspector fills its column
  start();
  goAside();
  ASSERT_TRUE(viewportSettles(lit));
  const ScreenPart first = part();
  const auto panel = [this] { return screen_->grab(picture().right() + 11, 80, 236, 580); };
  const auto pick = [this](const std::string& place) {
    press(place);
    away();
  };
  const auto changes = [&](const ScreenPart& before) {
    return settles(panel, [&](const ScreenPart& p) { return p.difference(before) > 0.003; });
  };

  const auto legend = [this] {
    for (const Control& c : controls())
      if (c.name.starts_with("links=")) return c.name;
    return std::string();
  };

  // A click on the floor draws the links of the facet there and fills the panel. Where their light spans decades, as
  // where one of them is a lamp, they are coloured by its logarithm.
  const ScreenPart empty = panel();
  pick(at(-300, 420));
  EXPECT_TRUE(legend().ends_with(" (log)")) << legend();
  pick(at(0, 415));
  ASSERT_TRUE(changes(empty)) << "nothing is picked";
  const ScreenPart picked = part(), row = panel();
  EXPECT_GT(picked.difference(first), 0.005) << "no links are drawn";
  EXPECT_TRUE(has("Inspector/F") && has("Inspector/F B"));
  // Its column; a filter that no voxel passes; and off again.
  click("Inspector/Column");
  away();
  ASSERT_TRUE(changes(row)) << "no column is shown";
  EXPECT_TRUE(legend().ends_with(" links")) << legend();
  const ScreenPart column = panel(), lines = part();
  enter("Inspector/filter", "none");
  away();
  ASSERT_TRUE(changes(column)) << "the filter is not taken";
  EXPECT_GT(part().difference(lines), 0.003) << "the lines in the picture are not filtered";
  enter("Inspector/filter", "");
  away();
  // Another facet's row beside it.
  const ScreenPart before = panel();
  act("keydown shift");
  pick(at(-369, -301));
  act("keyup shift");
  ASSERT_TRUE(changes(before)) << "no comparison";
  // A drag turns the camera and picks nothing; a click beside the scene lets go.
  pick(at(-637, 37));
  ASSERT_TRUE(settles([this] { return part(); }, [&](const ScreenPart& p) { return p == first; })) << "not let go";
  EXPECT_EQ(panel(), empty);
  mouse().dragThrough({at(-130, 37), at(29, 77)});
  away();
  ASSERT_TRUE(settles([this] { return part(); }, [&](const ScreenPart& p) { return p.difference(first) > 0.05; }));
  EXPECT_EQ(panel(), empty) << "a drag picks";
  quit();
}

TEST_F(WindowToolsTest, LightsAreAddedDraggedAndSavedBesideTheScene) {
  const std::filesystem::path scene = folder_.path / "a.glb", sidecar = sidecarPath(scene);
  std::filesystem::copy_file(assets() / "box.glb", scene);
  const std::string sha = sha256File(scene);
  fold(R"(["Accuracy", "Scene", "Objects", "Settings"])");
  start({}, scene);
  goAside();
  ASSERT_TRUE(viewportSettles(lit));
  const ScreenPart first = viewport();

  // "point": one ahead of the camera, in the middle of the picture.
  click("Lights/point");
  away();
  ASSERT_TRUE(viewportSettles([&](const ScreenPart& p) { return p.difference(first) > 0.3; })) << "nothing is added";
  const ScreenPart added = viewport();
  const auto drag = [&](int fromX, int fromY, int toX, int toY) {
    for (const std::string& step : {fmt::format("mousemove {} {}", fromX, fromY), std::string("mousedown 1"),
                                    fmt::format("mousemove {} {}", (fromX + toX) / 2, (fromY + toY) / 2),
                                    fmt::format("mousemove {} {}", toX, toY), std::string("mouseup 1")}) {
      act(step);
      rests();
    }
    away();
  };
  const Control::Area p = picture();
  const int x = p.x + p.width / 2, y = p.y + p.height / 2;
  drag(x, y, x - 100, y - 80);
  ASSERT_TRUE(viewportSettles([&](const ScreenPart& p) { return p != added; })) << "it is not dragged";
  EXPECT_FALSE(std::filesystem::exists(sidecar)) << "saved without being asked";
  const auto save = [&] {
    click("Lights/Save");
    away();
  };
  save();
  ASSERT_TRUE(says("Saved lights, materials, objects, bookmarks and region to " + sidecar.string()));
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
  const double pixel = 2 * -moved.z * std::tan(own.cameras[0].yfov / 2) / p.height;
  EXPECT_NEAR(moved.x / pixel, -100, 2);
  // The camera stands before the open side of the Box; the light is in it.
  const glm::dvec3 inside = point.position - own.origin;
  EXPECT_TRUE(glm::all(glm::greaterThan(inside, glm::dvec3(own.boundsMin))) &&
              glm::all(glm::lessThan(inside, glm::dvec3(own.boundsMax))))
      << "a new light is outside of the scene";
  EXPECT_GT(own.cameras[0].position.z - own.origin.z, own.boundsMax.z);

  // Where it cannot be saved: said, and nothing is lost.
  std::filesystem::remove(sidecar);
  std::filesystem::create_directory(sidecar);
  drag(x - 100, y - 80, x + 35, y + 19);
  save();
  EXPECT_TRUE(says("Lights, materials, objects, bookmarks and region stay in this window, unsaved"));
  std::filesystem::remove(sidecar);
  save();
  for (int i = 0; i < 100 && !std::filesystem::exists(sidecar); ++i) pause(0.1);
  EXPECT_GT(readSidecar(sidecar).lights->at(1).position.x, own.cameras[0].position.x);
  quit();
  EXPECT_EQ(sha256File(scene), sha) << "the scene's file was written to";

  start({}, scene);
  EXPECT_TRUE(says("lights of a.glb.irad.json"));
  key("ctrl+q");
  EXPECT_EQ(window_->wait(60), 0);
}

TEST_F(WindowToolsTest, TheMenuCapturesAFrameWithRenderDoc) {
  startsProgram_ = true;
  environment_["LD_PRELOAD"] = (buildFolder() / "tests/renderdoc/librenderdoc.so").string();
  start();
  goAside();
  ASSERT_TRUE(viewportSettles(lit));
  choose("Menu/File", "Capture a frame with RenderDoc");
  away();
  EXPECT_TRUE(says("RenderDoc saved out/captures/box_capture.rdc")) << window_->log();
  EXPECT_EQ(slurp(folder_.path / "out/captures/box_capture.rdc"), "RDOC");
  ASSERT_TRUE(viewportSettles(lit)) << "no picture after the capture";
  quit();
}

TEST_F(WindowToolsTest, RecordsFramesWhileItIsAskedTo) {
  fold(R"(["Settings"])");
  start({"--out", (folder_.path / "out").string()});
  goAside();
  ASSERT_TRUE(viewportSettles(lit));
  // "Record" at the right end of the strip's tabs; the same button ends it.
  record(2);
  ASSERT_TRUE(says("Recorded ")) << window_->log();
  const auto files = contents(folder_.path / "out" / "recording.001");
  ASSERT_EQ(files.size(), 4u);
  const auto trace = nlohmann::json::parse(files.at("trace.json"));
  const auto pictures = [&](const char* stage) {
    return std::count_if(trace["traceEvents"].begin(), trace["traceEvents"].end(),
                         [&](const auto& event) { return event["name"] == stage; });
  };
  EXPECT_GE(pictures("frame"), 3) << "pictures do not follow each other while it records";
  EXPECT_GE(pictures("RE Forward"), 3);
  EXPECT_TRUE(files.at("frames.csv").starts_with("frame,kind,began_ms,cpu_ms,"));
  // It sleeps again.
  goAside();
  ASSERT_TRUE(viewportSettles(lit));
  quit();
}

}  // namespace
}  // namespace irad::test::window_tools_suite
