// The window as a user has it: `irad view` under a virtual X server of the test's own, driven by synthetic keys and
// mouse, watched through the server's framebuffer. Skipped, in words, where Xvfb or xdotool is not installed.
#include <gtest/gtest.h>

#if IRAD_UI

#include <functional>
#include <nlohmann/json.hpp>

#include "gi/views.h"
#include "renderer/scene/sidecar.h"
#include "tests/file_drop.h"
#include "tests/scene_files.h"
#include "tests/virtual_screen.h"

namespace irad::test {
namespace {

class WindowTest : public ::testing::Test {
 protected:
  void SetUp() override {
    for (const char* program : {"Xvfb", "xdotool"})
      if (!installed(program)) GTEST_SKIP() << program << " is not installed: the window is not tested";
    screen_ = std::make_unique<VirtualScreen>(1600, 1000);
  }
  void TearDown() override {
    if (HasFailure() && window_) std::cerr << "irad said:\n" << window_->log();
  }

  /// A small Box, so that one picture takes a fraction of a second on a CPU rasterizer.
  void start(std::vector<std::string> more = {}, const std::filesystem::path& scene = assets() / "box.glb") {
    std::vector<std::string> command{IRAD_BINARY, "view",           scene.string(), "--size",
                                     "1280x720",  "--validate",     "--set",        "voxel.resolution=32",
                                     "--set",     "matrix.rays=32", "--set",        "specular.mode=off"};
    command.insert(command.end(), more.begin(), more.end());
    window_ = std::make_unique<Process>(command, folder_.path, screen_->environment());
  }
  /// Remembered from an earlier run, as a JSON array of titles: the other panels are where a test looks for them.
  void fold(const char* panels) {
    const std::filesystem::path folder = std::filesystem::path(screen_->environment().at("XDG_CONFIG_HOME")) / "irad";
    std::filesystem::create_directories(folder);
    std::ofstream(folder / "window.json") << fmt::format(R"({{"format": 1, "folded": {}}})", panels);
  }
  void xdotool(const std::string& arguments) { screen_->xdotool(arguments); }
  void key(const std::string& name) { screen_->key(name); }

  /// The middle of the viewport of a 1280 x 720 window: ui/layout.h gives x 332..998, y 30..532. The mouse stays in the
  /// viewport but out of this part: the server draws its pointer into the framebuffer.
  ScreenPart viewport() const { return screen_->grab(400, 100, 500, 380); }

  /// The part of it above the messages.
  ScreenPart part() const { return screen_->grab(400, 60, 500, 220); }

  bool drop(const std::vector<std::filesystem::path>& files) { return dropFiles(screen_->display(), "irad", files); }
  /// The program prints `text`, in time.
  bool says(const std::string& text, double seconds = 30) {
    for (int i = 0; i < 20 * seconds && window_->log().find(text) == std::string::npos; ++i) pause(0.05);
    return window_->log().find(text) != std::string::npos;
  }
  /// Waits for the progress bar in the middle of the viewport, presses its button, waits until the program says so.
  void cancel(const std::function<void()>& startWork) {
    const auto times = [this] {
      const std::string log = window_->log();
      size_t n = 0;
      for (size_t at = 0; (at = log.find("was cancelled", at)) != std::string::npos; ++at) ++n;
      return n;
    };
    const auto bar = [this] { return screen_->grab(490, 255, 280, 20); };
    const ScreenPart none = bar();
    const size_t before = times();
    startWork();
    for (int i = 0; i < 200 && bar() == none; ++i) pause(0.05);
    ASSERT_NE(bar(), none) << "no progress is shown";
    xdotool("mousemove 824 302 sleep 0.3 mousedown 1 sleep 0.3 mouseup 1");
    for (int i = 0; i < 200 && times() == before; ++i) pause(0.05);
    EXPECT_EQ(times(), before + 1) << "the button does not cancel";
    xdotool("mousemove 360 510");
  }
  std::filesystem::path copyShaders() const {
    const std::filesystem::path copy = folder_.path / "shaders";
    std::filesystem::copy(std::filesystem::path(IRAD_SOURCE_DIR) / "shaders", copy,
                          std::filesystem::copy_options::recursive);
    return copy;
  }

  /// Waits until the program sleeps (no processor time in 0.8 s: nothing more will change) and `region` has stayed the
  /// same meanwhile and satisfies `wanted`; false after `seconds`.
  bool settles(const std::function<ScreenPart()>& region, const std::function<bool(const ScreenPart&)>& wanted,
               double seconds = 120) {
    for (const auto end = Clock::now() + std::chrono::duration<double>(seconds); Clock::now() < end;) {
      if (!window_->running()) return false;
      const ScreenPart before = region();
      const double used = window_->cpuSeconds();
      pause(0.8);
      if (window_->cpuSeconds() - used <= 0.02 && region() == before && wanted(before)) return true;
    }
    return false;
  }
  bool viewportSettles(const std::function<bool(const ScreenPart&)>& wanted) {
    return settles([this] { return viewport(); }, wanted);
  }

  TemporaryFolder folder_;
  std::unique_ptr<VirtualScreen> screen_;
  std::unique_ptr<Process> window_;
};

const auto lit = [](const ScreenPart& p) { return p.meanLuminance() > 0.05 && p.deviation() > 0.02; };

TEST_F(WindowTest, ShowsBoxAndAnswersKeysAndMouse) {
  start();
  ASSERT_TRUE(viewportSettles(lit)) << "mean " << viewport().meanLuminance() << ", deviation "
                                    << viewport().deviation();
  const ScreenPart first = viewport();
  EXPECT_LT(first.meanLuminance(), 0.9);
  // The panels hold text: both columns and the strip vary.
  EXPECT_GT(screen_->grab(5, 40, 310, 600).deviation(), 0.03);
  EXPECT_GT(screen_->grab(1010, 40, 260, 600).deviation(), 0.03);
  EXPECT_GT(screen_->grab(340, 540, 400, 100).deviation(), 0.03);

  // What settles() waits for is stated once: an idle window does no work, no picture and no processor time.
  xdotool("mousemove 360 510");
  ASSERT_TRUE(viewportSettles([&](const ScreenPart& p) { return p == first; }));
  const double used = window_->cpuSeconds();
  pause(3);
  EXPECT_LE(window_->cpuSeconds() - used, 0.05) << "seconds of processor time in 3 s of idling";

  // Another view and back: another picture, and the very same bits.
  key("2");
  ASSERT_TRUE(viewportSettles([&](const ScreenPart& p) { return p.difference(first) > 0.05; }))
      << "key 2 changed nothing";
  key("1");
  ASSERT_TRUE(viewportSettles([&](const ScreenPart& p) { return p == first; }))
      << "key 1 did not bring the picture back";

  // W flies forward.
  xdotool("keydown w sleep 0.4 keyup w");
  ASSERT_TRUE(viewportSettles([&](const ScreenPart& p) { return lit(p) && p.difference(first) > 0.2; }))
      << "W changed nothing";

  // A right drag looks around.
  const ScreenPart nearer = viewport();
  xdotool("mousemove 360 510 sleep 0.4 mousedown 3 sleep 0.4 mousemove 420 515 sleep 0.4 mouseup 3");
  ASSERT_TRUE(viewportSettles([&](const ScreenPart& p) { return p.difference(nearer) > 0.2; }))
      << "the drag changed nothing";

  // C returns to a camera of the scene: from the first to the second, and round to the first again.
  key("c");
  key("c");
  ASSERT_TRUE(viewportSettles([&](const ScreenPart& p) { return p == first; }))
      << "C twice did not return to the first camera";

  key("Escape");
  EXPECT_EQ(window_->wait(20), 0) << "status after Esc, with validation on";
}

TEST_F(WindowTest, CapturesReplayToTheSameBits) {
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

TEST_F(WindowTest, CapturesThatCannotBeWrittenSayWhy) {
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

TEST_F(WindowTest, HelpAndHiddenPanelsComeAndGo) {
  start();
  ASSERT_TRUE(viewportSettles(lit));
  xdotool("mousemove 360 510");
  const ScreenPart first = viewport();
  const auto column = [this] { return screen_->grab(5, 40, 310, 600); };
  const ScreenPart panels = column();

  key("F1");
  ASSERT_TRUE(viewportSettles([&](const ScreenPart& p) { return p.difference(first) > 0.1; })) << "F1 shows nothing";
  key("F1");
  ASSERT_TRUE(viewportSettles([&](const ScreenPart& p) { return p == first; }));

  key("F2");
  ASSERT_TRUE(settles(column, [&](const ScreenPart& p) { return p.difference(panels) > 0.5; })) << "F2 hides nothing";
  key("F2");
  ASSERT_TRUE(settles(column, [&](const ScreenPart& p) { return p.difference(panels) < 0.05; }));

  key("Escape");
  EXPECT_EQ(window_->wait(20), 0);
}

TEST_F(WindowTest, RemembersItsLayoutUntilItIsReset) {
  start();
  ASSERT_TRUE(viewportSettles(lit));
  xdotool("mousemove 360 510");
  const auto left = [this] { return screen_->grab(286, 60, 40, 400); };  // of the left column; then of the viewport
  const auto background = [this] { return screen_->grab(10, 500, 250, 200).deviation() < 0.01; };
  ASSERT_FALSE(background());
  // The edge of the left column, and the header of the settings.
  xdotool("mousemove 332 300 sleep 0.5 mousedown 1 sleep 0.5 mousemove 280 300 sleep 0.5 mouseup 1");
  const auto black = [](const ScreenPart& p) { return p.count(0x000000) > 0.9 * 40 * 400; };
  ASSERT_TRUE(settles(left, black)) << "the edge cannot be dragged";
  xdotool("mousemove 60 477 sleep 0.5 click 1 sleep 0.5 mousemove 360 510");
  ASSERT_TRUE(settles(left, [&](const ScreenPart&) { return background(); })) << "the settings do not fold";
  key("Escape");
  EXPECT_EQ(window_->wait(20), 0);

  start();
  ASSERT_TRUE(settles(left, black)) << "the column's width is forgotten";
  EXPECT_TRUE(background()) << "the settings are unfolded again";
  // View, Reset the layout.
  xdotool("mousemove 60 15 sleep 0.5 click 1 sleep 0.5 mousemove 80 95 sleep 0.5 click 1 sleep 0.5 mousemove 600 510");
  ASSERT_TRUE(settles(left, [&](const ScreenPart& p) { return !black(p) && !background(); })) << "not reset";
  key("Escape");
  EXPECT_EQ(window_->wait(20), 0);
}

TEST_F(WindowTest, OpensScenesFromFoldersAndSaysWhyItsLayoutIsLost) {
  std::filesystem::copy(assets() / "box.glb", folder_.path / "a.glb");
  const std::filesystem::path config = screen_->environment().at("XDG_CONFIG_HOME");
  std::filesystem::create_directories(config / "irad");
  std::ofstream(config / "irad/window.json") << "{\"format\": 1, \"left\": \"wide\"}";
  start();
  EXPECT_TRUE(says("left is \"wide\""));
  xdotool("mousemove 360 510");
  ASSERT_TRUE(viewportSettles(lit));
  const ScreenPart before = viewport();
  key("o");
  ASSERT_TRUE(viewportSettles([&](const ScreenPart& p) { return p.difference(before) > 0.5; })) << "no dialog";
  // ImGui looks at keys once per frame: they are held for longer than that.
  xdotool("mousemove 640 500 sleep 0.8 click 1 sleep 0.8 type --delay 60 " + (folder_.path / "a.glb").string());
  xdotool("keydown Return sleep 0.8 keyup Return");
  ASSERT_TRUE(viewportSettles([&](const ScreenPart&) {
    return slurp(config / "irad/window.json").find("a.glb") != std::string::npos;
  })) << "the scene is not loaded, or not remembered";
  key("Escape");
  EXPECT_EQ(window_->wait(20), 0);
}

TEST_F(WindowTest, ComparesTwoSetsOfSettings) {
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
      "mousemove 205 621 sleep 0.5 click 1 sleep 0.8 mousemove 160 642 sleep 0.5 click 1 sleep 0.5 mousemove 360 510");
  ASSERT_TRUE(settles(right, [&](const ScreenPart& p) { return p.difference(alsoA) > 0.3; })) << "B is not rebuilt";
  EXPECT_EQ(left(), a) << "A is B's";
  const ScreenPart b = right();
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

TEST_F(WindowTest, InspectsWhatIsClicked) {
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

TEST_F(WindowTest, LightsAreAddedDraggedAndSavedBesideTheScene) {
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

TEST_F(WindowTest, FollowsItsSize) {
  start();
  ASSERT_TRUE(viewportSettles(lit));
  const auto resize = [&](int width, int height) {
    xdotool(fmt::format("search --onlyvisible --name irad windowsize --sync {} {}", width, height));
  };
  // Beyond the old right edge there is nothing; after growing, the right column is there.
  const auto right = [this] { return screen_->grab(1300, 50, 280, 600); };
  EXPECT_EQ(right().deviation(), 0.0);
  resize(1600, 900);
  ASSERT_TRUE(settles(right, [](const ScreenPart& p) { return p.deviation() > 0.03; })) << "the window did not grow";
  ASSERT_TRUE(viewportSettles(lit));
  // Too small for anything, and back.
  resize(40, 30);
  pause(1);
  ASSERT_TRUE(window_->running());
  resize(1280, 720);
  ASSERT_TRUE(viewportSettles(lit));

  xdotool("mousemove 360 510");
  key("Escape");
  EXPECT_EQ(window_->wait(20), 0);
}

TEST_F(WindowTest, SurvivesBeingUnmappedAndResizedInAHurry) {
  start();
  ASSERT_TRUE(viewportSettles(lit));
  xdotool("mousemove 360 510");
  ASSERT_TRUE(viewportSettles(lit));
  const ScreenPart first = viewport();
  xdotool("search --onlyvisible --name irad windowunmap --sync");
  pause(0.5);
  xdotool("search --name irad windowmap --sync");
  ASSERT_TRUE(viewportSettles([&](const ScreenPart& p) { return p == first; })) << "not drawn again when mapped";

  // Sizes that come faster than frames.
  std::string sizes;
  for (const char* size : {"900 500", "1500 800", "700 700", "1100 400", "1280 720"})
    sizes += fmt::format(" search --name irad windowsize {} sleep 0.03", size);
  xdotool(sizes);
  ASSERT_TRUE(viewportSettles([&](const ScreenPart& p) { return p == first; })) << "the picture did not come back";
  key("Escape");
  EXPECT_EQ(window_->wait(20), 0);
}

TEST_F(WindowTest, TakesDroppedScenesAndRefusesOthersInWords) {
  start();
  xdotool("mousemove 360 510");
  ASSERT_TRUE(viewportSettles(lit));
  const ScreenPart first = part();

  // What is no scene leaves a message and the picture: no glTF, a folder, a file that goes before it is read.
  std::ofstream(folder_.path / "bad.glb") << "not a scene";
  for (const char* name : {"bad.glb", ".", "gone.glb"}) {
    ASSERT_TRUE(drop({folder_.path / name}));
    EXPECT_TRUE(says(name)) << window_->log();
    ASSERT_TRUE(settles([this] { return part(); }, [&](const ScreenPart& p) { return p == first; })) << name;
  }
  const ScreenPart messages = screen_->grab(340, 400, 300, 120);
  EXPECT_GT(messages.deviation(), 0.03);

  // A scene replaces the one shown, whatever its name; of several the last is taken.
  const std::filesystem::path triangle = triangleFile().write(folder_.path, "100% drei\u00E9ck #1.gltf");
  ASSERT_TRUE(drop({assets() / "box.glb", triangle}));
  ASSERT_TRUE(settles([this] { return part(); }, [&](const ScreenPart& p) { return p.difference(first) > 0.2; }))
      << "the dropped scene is not shown";
  ASSERT_TRUE(drop({assets() / "box.glb"}));
  ASSERT_TRUE(settles([this] { return part(); }, [&](const ScreenPart& p) { return p == first; }))
      << "the first scene did not come back with the same bits";
  key("Escape");
  EXPECT_EQ(window_->wait(20), 0);
}

TEST_F(WindowTest, ADroppedPictureIsTheReference) {
  start({"--view", "reference-picture"});
  xdotool("mousemove 360 510");
  const auto black = [](const ScreenPart& p) { return p.meanLuminance() < 0.01; };  // but for a light's handle
  ASSERT_TRUE(settles([this] { return part(); }, black)) << "a reference that nobody gave";
  // Neither a file that is no picture nor one that is gone; then a picture that is not black.
  std::ofstream(folder_.path / "bad.exr") << "no picture";
  for (const char* name : {"bad.exr", "gone.hdr"}) {
    ASSERT_TRUE(drop({folder_.path / name}));
    EXPECT_TRUE(says(name)) << window_->log();
  }
  ASSERT_TRUE(settles([this] { return part(); }, black));
  ASSERT_TRUE(drop({std::filesystem::path(IRAD_SOURCE_DIR) / "tests/golden/box.main.lit.exr"}));
  ASSERT_TRUE(settles([this] { return part(); }, lit)) << "the picture is not taken";
  key("Escape");
  EXPECT_EQ(window_->wait(20), 0);
}

TEST_F(WindowTest, ReloadsShadersAndWhatTheyMade) {
  const std::filesystem::path shaders = copyShaders();
  start({"--shaders", shaders.string(), "--view", "voxel-albedo"});
  xdotool("mousemove 360 510");
  ASSERT_TRUE(viewportSettles(lit));
  const ScreenPart first = part();

  key("F5");
  EXPECT_TRUE(says("no shader has changed"));

  // An error: the message names file and line, the old shaders stay.
  const std::filesystem::path facets = shaders / "gi/facet_shade.comp";
  const std::string good = slurp(facets);
  std::ofstream(facets) << good << "\nmistake\n";
  key("F5");
  EXPECT_TRUE(says("The old shaders stay in use"));
  EXPECT_TRUE(says("facet_shade.comp")) << window_->log();
  ASSERT_TRUE(settles([this] { return part(); }, [&](const ScreenPart& p) { return p == first; }));

  // A shader of the voxels: they are made anew, and what follows from them.
  const std::string packed = "packAlbedo(";
  std::string changed = good;
  ASSERT_NE(changed.find(packed), std::string::npos);
  changed.replace(changed.find(packed), packed.size(), packed + "vec3(0.9, 0.1, 0.5) * ");
  std::ofstream(facets) << changed;
  key("F5");
  EXPECT_TRUE(says("Compiled again: gi/facet_shade.comp"));
  ASSERT_TRUE(settles([this] { return part(); }, [&](const ScreenPart& p) { return p.difference(first) > 0.5; }))
      << "the voxels keep what the old shader made of them";
  std::ofstream(facets) << good;
  key("F5");
  ASSERT_TRUE(settles([this] { return part(); }, [&](const ScreenPart& p) { return p == first; }))
      << "the first picture did not come back with its shader";
  key("Escape");
  EXPECT_EQ(window_->wait(20), 0);
}

TEST_F(WindowTest, ABannerNamesWrongNumbersUntilTheyAreGone) {
  const std::filesystem::path shaders = copyShaders();
  start({"--shaders", shaders.string()});
  xdotool("mousemove 360 510");
  ASSERT_TRUE(viewportSettles(lit));
  const ScreenPart first = part();
  const auto top = [this] { return screen_->grab(340, 32, 650, 30); };
  constexpr uint32_t kAlarm = 0x9E1714;
  EXPECT_EQ(top().count(kAlarm), 0);

  // One facet's direct light becomes NaN.
  const std::filesystem::path gather = shaders / "gi/gather.comp";
  const std::string good = slurp(gather), wanted = "vec4(sum / float(p.samples), 0.0f)";
  std::string bad = good;
  const size_t at = bad.find(wanted);
  ASSERT_NE(at, std::string::npos);
  bad.replace(at, wanted.size(), "vec4(facet == 1000u ? vec3(uintBitsToFloat(0x7FC00000u | facet)) : sum, 0.0f)");
  std::ofstream(gather) << bad;
  key("F5");
  ASSERT_TRUE(settles(top, [&](const ScreenPart& p) { return p.count(kAlarm) > 650 * 30 / 2; })) << "no banner";
  std::ofstream(gather) << good;
  key("F5");
  ASSERT_TRUE(settles(top, [&](const ScreenPart& p) { return p.count(kAlarm) == 0; })) << "the banner stays";
  ASSERT_TRUE(settles([this] { return part(); }, [&](const ScreenPart& p) { return p == first; }))
      << "the first picture did not come back";
  key("Escape");
  EXPECT_EQ(window_->wait(20), 0);
}

TEST_F(WindowTest, RecordsFramesWhileItIsAskedTo) {
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

TEST_F(WindowTest, ALostDeviceEndsItWithAMessage) {
  // In the load, and once pictures are drawn.
  for (const char* fault : {"lost=30", "lost=400"}) {
    start({"--inject", fault});
    for (int i = 0; i < 400 && window_->running(); ++i) {  // something to draw until it happens
      screen_->xdotool(fmt::format("mousemove {} 510", 360 + i % 2));
    }
    EXPECT_EQ(window_->wait(60), 1) << fault;
    EXPECT_TRUE(says("irad: error: ")) << fault;
    EXPECT_TRUE(says("the device was lost")) << fault;
  }
}

TEST_F(WindowTest, LoadsAndRebuildsCanBeCancelled) {
  // Large enough for some seconds of work.
  const std::filesystem::path shaders = copyShaders();
  start({"--shaders", shaders.string(), "--set", "voxel.resolution=64", "--set", "matrix.rays=256"});
  xdotool("mousemove 360 510");
  ASSERT_TRUE(viewportSettles(lit));
  const ScreenPart first = part();

  const std::filesystem::path copy = folder_.path / "copy.glb";
  std::filesystem::copy_file(assets() / "box.glb", copy);
  cancel([&] { ASSERT_TRUE(drop({copy})); });
  EXPECT_TRUE(says("copy.glb: loading was cancelled"));
  ASSERT_TRUE(settles([this] { return part(); }, [&](const ScreenPart& p) { return p == first; }));

  // Another sequence of rays in every row.
  const std::filesystem::path rays = shaders / "shared/sampling.h";
  std::string text = slurp(rays);
  const size_t half = text.find("0.5");
  ASSERT_NE(half, std::string::npos);
  text.replace(half, 3, "0.4");
  std::ofstream(rays) << text;
  cancel([&] { key("F5"); });
  EXPECT_TRUE(says("The rebuild was cancelled"));
  ASSERT_TRUE(settles([this] { return part(); }, [&](const ScreenPart& p) { return p == first; }));

  // Esc ends the program in the middle of the work.
  ASSERT_TRUE(drop({copy}));
  pause(0.5);
  key("Escape");
  EXPECT_EQ(window_->wait(5), 0);
}

TEST_F(WindowTest, ScreenshotOfTheWholeWindow) {
  start({"--exit-after", "3", "--screenshot", "window.png"});
  ASSERT_EQ(window_->wait(120), 0);
  // The PNG header's width and height.
  const std::string png = slurp(folder_.path / "window.png");
  ASSERT_GT(png.size(), 10000u);
  const auto word = [&](size_t at) {
    uint32_t value = 0;
    for (size_t b = 0; b < 4; ++b) value = value << 8 | static_cast<uint8_t>(png[at + b]);
    return value;
  };
  EXPECT_EQ(word(16), 1280u);
  EXPECT_EQ(word(20), 720u);
}

TEST_F(WindowTest, RefusesWhatItCannotShow) {
  window_ = std::make_unique<Process>(std::vector<std::string>{IRAD_BINARY, "view", "absent.glb"}, folder_.path,
                                      screen_->environment());
  EXPECT_EQ(window_->wait(60), 3);
  EXPECT_NE(window_->log().find("absent.glb"), std::string::npos);
  start({"--view", "lti"});
  EXPECT_EQ(window_->wait(60), 2);
  EXPECT_NE(window_->log().find("lit"), std::string::npos) << "the near match is named";
  start({"--inspect", "16,16,16"});
  EXPECT_EQ(window_->wait(60), 2);
  EXPECT_NE(window_->log().find("the nearest solid voxel is"), std::string::npos) << window_->log();
}

}  // namespace
}  // namespace irad::test

#else

TEST(Window, NotBuilt) {
  GTEST_SKIP() << "built without IRAD_UI";
}

#endif
