// A walk through the whole window: every view of the combo against the headless program's picture, every panel and a
// control in each, the window as a whole against pictures that a person has looked at.
#include <gtest/gtest.h>

#if IRAD_OIIO

#include <algorithm>
#include <nlohmann/json.hpp>

#include "gi/views/views.h"
#include "renderer/scene/light_json.h"
#include "tests/png.h"
#include "tests/window_fixture.h"
#include "ui/panel.h"
#include "ui/setting_rows.h"

namespace irad::test::window_walk_suite {
namespace {

using Area = Control::Area;

/// Largest difference of a channel in one pixel, of 255. Both pictures are of one size.
int difference(const ScreenPart& a, const ScreenPart& b, int x, int y) {
  int most = 0;
  for (int c = 0; c < 3; ++c) most = std::max(most, std::abs(int{a.at(x, y, c)} - int{b.at(x, y, c)}));
  return most;
}

/// How far two pictures of one size are apart outside of `left out`.
struct Apart {
  int pixels = 0, most = 0;  ///< that differ; largest difference of a channel, of 255
};
Apart apart(const ScreenPart& a, const ScreenPart& b, const std::vector<Area>& leftOut = {}) {
  Apart d;
  for (int y = 0; y < a.height; ++y)
    for (int x = 0; x < a.width; ++x) {
      const bool out = std::ranges::any_of(leftOut, [&](const Area& area) { return area.holds(x, y); });
      const int most = out ? 0 : difference(a, b, x, y);
      d.pixels += most > 0;
      d.most = std::max(d.most, most);
    }
  return d;
}

/// Settings under which the light is solved so far that the window's and the headless program's agree but for the
/// rounding of few pixels: the window's sweeps come in other portions.
constexpr int kRounding = 1;  ///< of 255

class WindowWalk : public WindowTest {
 protected:
  WindowWalk() { firstSizes_ = true; }
  static std::vector<std::string> settings(const std::vector<std::string>& more = {}) {
    std::vector<std::string> words{"--set", "voxel.resolution=16",         "--set", "matrix.rays=32",
                                   "--set", "specular.mode=off",           "--set", "solver.tolerance=1e-6",
                                   "--set", "light.shadow_resolution=2048"};  // the default
    words.insert(words.end(), more.begin(), more.end());
    return words;
  }
  /// Pictures of the headless program at the viewport's size: VIEW.png.
  std::filesystem::path render(const std::string& views, const std::vector<std::string>& more) {
    const std::filesystem::path out = folder_.path / fmt::format("headless.{}", renders_++);
    std::vector<std::string> command = settings(more);
    command.insert(command.begin(), {"render", (assets() / "box.glb").string(), "--view", views, "--size",
                                     fmt::format("{}x{}", size_.width, size_.height), "--out", out.string()});
    const RunResult result = runIrad(command);
    EXPECT_EQ(result.status, 0) << result.err;
    return out;
  }
  /// All of the picture.
  ScreenPart shown() {
    const Area p = picture();
    return screen_->grab(p.x, p.y, p.width, p.height);
  }
  /// From now on headless pictures have the size of the window's.
  void takeSize() { size_ = picture(); }
  /// In time the viewport shows the headless picture: bit for bit, but where H is seen to its rounding in one pixel of
  /// a thousand. Legends are left out, and what is said in the picture of a view that lacks its input.
  bool shows(const std::filesystem::path& folder, const ViewInfo& view) {
    const ScreenPart wanted = readPng(folder / (view.name + std::string(".png")));
    rest();  // what the mouse is on may have a tooltip that lies over the picture
    Apart d;
    for (const auto end = Clock::now() + std::chrono::seconds(20); Clock::now() < end; pause(0.05)) {
      d = apart(shown(), wanted, overPicture());
      if (d.most <= kRounding && d.pixels <= size_.width * size_.height / 1000) return true;
    }
    ADD_FAILURE() << view.name << ": " << d.pixels << " pixels differ, by at most " << d.most << " of 255";
    return false;
  }
  std::vector<Area> overPicture() const {
    std::vector<Area> areas;
    for (const Control& c : controls())
      if (c.name == "missing/box" || c.name == "legend" || c.name.starts_with("fold-"))
        areas.push_back({c.area.x - size_.x, c.area.y - size_.y, c.area.width + 1, c.area.height + 1});
    return areas;
  }
  /// In time the viewport is as wanted.
  bool becomes(const std::function<bool(const ScreenPart&)>& wanted) {
    rest();
    for (const auto end = Clock::now() + std::chrono::seconds(20); Clock::now() < end; pause(0.05))
      if (wanted(shown())) return true;
    return false;
  }
  ScreenPart column(Region region) {
    const Area p = picture();
    return region == Region::Left ? screen_->grab(0, p.y, p.x, 690)
                                  : screen_->grab(p.right(), p.y, 1280 - p.right(), 690);
  }
  std::filesystem::path preferencesFile() const {
    return std::filesystem::path(screen_->environment().at("XDG_CONFIG_HOME")) / "irad/window.json";
  }

  /// Moves the mouse to an empty place in the menu bar; its picture ends above the viewport.
  void rest() {
    act("mousemove 700 6");
    rests();
  }

 private:
  int renders_ = 0;
  Area size_;  ///< of the picture
};

TEST_F(WindowWalk, EveryViewIsTheHeadlessPicture) {
  fold(R"(["Accuracy", "Scene", "Cameras", "Settings", "Compare", "Inspector", "Solver", "Memory"])");
  start(settings());
  takeSize();
  quit();
  const std::vector<std::string> withReference{"--reference", (render("indirect", {}) / "indirect.exr").string()};
  start(settings(withReference));
  takeSize();
  const std::filesystem::path headless = render("all", withReference);
  rests();
  click("Lights/handles in the picture");  // none over the picture
  rest();
  for (const ViewInfo& view : views()) {
    if (view.isFrom(FROM_ORACLE)) continue;  // headless it is refused: box has none
    if (view.view < 9)
      key(std::to_string(view.view + 1));
    else
      choose("View/view", view.name);
    EXPECT_TRUE(shows(headless, view)) << view.name;
  }
  quit();
}

TEST_F(WindowWalk, EveryPanelUnfoldsAndDoesWhatItSays) {
  std::string titles;
  for (const auto& panel : makePanels()) titles += fmt::format("{}\"{}\"", titles.empty() ? "" : ", ", panel->title());
  fold(fmt::format("[{}]", titles).c_str());
  std::filesystem::copy_file(assets() / "box.glb", folder_.path / "walk.glb");
  start(settings({"--out", "out"}));
  rests();
  takeSize();
  // No handles of lights in the picture.
  click("Lights");
  click("Lights/handles in the picture");
  click("Lights");
  rest();
  const ScreenPart left = column(Region::Left), right = column(Region::Right);
  const ScreenPart first = shown();
  const auto comesBack = [&] {
    return becomes([&](const ScreenPart& p) { return apart(p, first).most <= kRounding; });
  };

  // Every panel there is: unfolded it shows something, folded again it leaves no trace.
  for (const auto& panel : makePanels()) {
    if (panel->region() == Region::Bottom) continue;  // below
    const ScreenPart folded = panel->region() == Region::Left ? left : right;
    click(panel->title());
    rest();
    EXPECT_GT(column(panel->region()).difference(folded), 0.005) << panel->title() << " is empty";
    click(panel->title());
    rest();
    EXPECT_EQ(column(panel->region()), folded) << panel->title();
  }

  // Scene: a path.
  click("Scene");
  enter("Scene/open", "walk.glb");
  const auto opened = [&](const ScreenPart& p) { return p == first && contains(slurp(preferencesFile()), "walk.glb"); };
  EXPECT_TRUE(becomes(opened)) << "the scene typed is not opened";
  click("Scene");

  // Lights: the intensity of the one there is, typed; and taken back.
  key("3");
  click("Lights");
  click("Lights/0");
  rest();
  const ScreenPart direct = shown();
  enterNumber("Lights/0/intensity", "3000");
  rest();
  std::vector<Light> lights = loadScene(assets() / "box.glb").lights;
  lights.at(0).intensity = 3000;
  EXPECT_TRUE(shows(render("direct", {"--lights", lightsToJson(lights)}), *viewInfo(VIEW_DIRECT)));
  click("Lights/Revert");
  EXPECT_TRUE(becomes([&](const ScreenPart& p) { return p == direct; })) << "not reverted";
  // And dragged: the intensity to the right by half of the field, a hundredth of itself a pixel; the position.
  drag("Lights/0/intensity", 70);
  rest();
  EXPECT_GT(shown().meanLuminance(), 1.05 * direct.meanLuminance()) << "the intensity is not dragged";
  drag("Lights/0/position", -60, 0, 1.0 / 6);
  rest();
  const ScreenPart brighter = shown();
  EXPECT_GT(brighter.difference(direct), 0.1);
  click("Lights/Revert");
  EXPECT_TRUE(becomes([&](const ScreenPart& p) { return p == direct; })) << "dragged values are not reverted";
  click("Lights");

  // Cameras: a bookmark of where one has flown to, beside the scene's two.
  click("Cameras");
  act("keydown w sleep 0.3 keyup w");
  rest();
  const ScreenPart flown = shown();
  EXPECT_GT(flown.difference(direct), 0.1);
  click("Cameras/Add bookmark");
  click("Cameras/0");
  EXPECT_TRUE(becomes([&](const ScreenPart& p) { return p == direct; })) << "the scene's camera";
  click("Cameras/2");
  EXPECT_TRUE(becomes([&](const ScreenPart& p) { return p == flown; })) << "the bookmark";
  click("Cameras/0");
  click("Cameras");

  // Settings: voxel.resolution, typed.
  key("1");
  click("Settings");
  if (!has("Settings/voxel.resolution")) click("Settings/voxel");
  enterNumber("Settings/voxel.resolution", "24");
  rest();  // or the slider's tooltip lies over the picture
  EXPECT_TRUE(shows(render("lit", {"--set", "voxel.resolution=24"}), *viewInfo(VIEW_LIT)));
  enterNumber("Settings/voxel.resolution", "16");
  click("Settings");
  rest();
  EXPECT_TRUE(comesBack()) << "16 voxels again";

  // View: range and colour map of depth.
  key("9");
  click("View");
  choose("View/view.range", "percentile");
  choose("View/view.color_map", "grey");
  EXPECT_TRUE(shows(render("depth", {"--set", "view.range=percentile", "--set", "view.color_map=grey"}),
                    *viewInfo(VIEW_DEPTH)));
  click("View");
  key("1");
  EXPECT_TRUE(comesBack()) << "lit again";

  // Compare: the same settings on both sides differ in the letters and the line only.
  click("Compare");
  click("Compare/Compare with these settings");
  const auto compared = [&](const ScreenPart& p) { return p != first && p.difference(first) < 0.01; };
  EXPECT_TRUE(becomes(compared)) << "no comparison";
  click("Compare/End the comparison");
  EXPECT_TRUE(comesBack()) << "the comparison does not end";
  click("Compare");

  // Inspector: a click on the floor, a filter that nothing passes, done.
  click("Inspector");
  press(at(-130, 415));
  WindowTest::shown("Inspector/Trace this ray");  // below its table
  const auto table = [this] {
    const Area filter = WindowTest::shown("Inspector/filter").area;
    return screen_->grab(picture().right() + 6, filter.bottom() + 28, 230, 80);
  };
  EXPECT_GT(table().deviation(), 0.05) << "no links";
  click("Inspector/filter");
  type("zzz");
  rest();
  EXPECT_LT(table().deviation(), 0.02) << "not filtered: only the lines between columns are left";
  click("Inspector/Clear");
  hold("Escape");  // the object, which the click has chosen, too
  click("Inspector");
  EXPECT_TRUE(comesBack()) << "Clear leaves something";

  // Solver: from the dark, a sweep, and on.
  key("4");
  rests();
  const ScreenPart indirect = shown();
  click("Solver");
  click("Solver/pause");
  click("Solver/H = 0");
  rests();
  const ScreenPart dark = shown();
  EXPECT_LT(dark.meanLuminance(), 0.2 * indirect.meanLuminance());
  click("Solver/Step");
  rests();
  EXPECT_GT(shown().meanLuminance(), dark.meanLuminance());
  EXPECT_LT(shown().meanLuminance(), indirect.meanLuminance());
  click("Solver/pause");  // that is, resume
  EXPECT_TRUE(becomes([&](const ScreenPart& p) { return apart(p, indirect).most <= kRounding; }));
  click("Solver");

  // Memory: its table as a file.
  click("Memory");
  click("Memory/Save CSV");
  EXPECT_TRUE(says("Saved "));
  click("Memory");

  // Timings: values of two frames under the mouse; every tab, and a record of a second.
  const int low = picture().height;
  click("Timings");
  rest();
  EXPECT_LT(picture().height, low - 100) << "the strip does not unfold";
  const auto window = [this] { return screen_->grab(0, 0, 1280, 720); };
  rest();
  const ScreenPart unread = window();
  std::vector<ScreenPart> readings;
  for (const int x : {370, 620}) {
    act(fmt::format("mousemove {} {}", picture().x + x, picture().bottom() + 90));
    rests();
    readings.push_back(window());
    EXPECT_GT(readings.back().difference(unread), 0.005) << "nothing is read at " << x;
  }
  EXPECT_GT(readings[0].difference(readings[1]), 0.005);
  rest();
  const auto strip = [this] {
    const Area p = picture();
    return screen_->grab(p.x + 8, p.bottom() + 60, p.width - 17, 720 - p.bottom() - 70);
  };
  ScreenPart before = strip();
  for (const char* tab : {"Table", "One-time", "Compare", "Plot"}) {
    click(std::string("Timings/") + tab);
    EXPECT_GT(strip().difference(before), 0.01) << tab;
    before = strip();
  }
  record(1);
  EXPECT_TRUE(says("Recorded "));
  quitDiscarding();  // the bookmark, and settings of the view
}

/// Settings with which the scene is read anew, and what a pixel looks for itself.
TEST_F(WindowWalk, SettingsOfTheSceneAndOfEmittersAreDrawnAtOnce) {
  std::vector<std::string> folded;
  for (const auto& panel : makePanels())
    if (panel->title() != std::string("Settings")) folded.emplace_back(panel->title());
  fold(nlohmann::json(folded).dump().c_str());
  start(settings({"--set", "sample.emitter_rays=1"}));  // more take seconds a frame here
  rests();
  takeSize();
  click("Lights");
  click("Lights/handles in the picture");
  click("Lights");
  const ViewInfo& lit = *viewInfo(VIEW_LIT);

  click("Settings/scene.double_sided");
  rest();
  EXPECT_TRUE(shows(render("lit", {"--set", "scene.double_sided=true"}), lit));
  click("Settings/scene.double_sided");
  rest();
  EXPECT_TRUE(shows(render("lit", {}), lit));
  choose("Settings/sample.emitters", "pixels");
  rest();
  EXPECT_TRUE(shows(render("lit", {"--set", "sample.emitters=pixels", "--set", "sample.emitter_rays=1"}), lit));
  quitDiscarding();
}

/// The whole window against pictures of it that a person has looked at. After a change that is meant:
///
///   IRAD_BLESS=1 build/tests/window_walk_test --gtest_filter='*Whole*'    (then look at them)
///
/// In panels and menus no more pixels may differ visibly (by more than a sixteenth) than a digit or two have: room for
/// a value rounded the other way. A word that moves by a pixel differs in more (AMovedWordIsSeen). The pictures in the
/// viewport are compared elsewhere; here one pixel in a hundred may differ, which edges on another driver need. Times
/// and the plot of them are left out.
struct WholeWindow {
  static constexpr int kWidth = 1280, kHeight = 720, kVisible = 16, kPanelPixels = 60;

  Area picture;                 ///< the viewport
  int panel = 0, viewport = 0;  ///< pixels that differ visibly
  bool within() const { return panel <= kPanelPixels && viewport <= picture.width * picture.height / 100; }
};
/// `picture`: the viewport; the times are below it. `leftOut`: what else has times.
WholeWindow compareWhole(const ScreenPart& ours, const ScreenPart& golden, const Area& picture,
                         const std::vector<Area>& leftOut = {}) {
  WholeWindow d{picture};
  const Area times{picture.x, picture.bottom(), picture.width, WholeWindow::kHeight - picture.bottom()};
  for (int y = 0; y < WholeWindow::kHeight; ++y)
    for (int x = 0; x < WholeWindow::kWidth; ++x)
      if (!times.holds(x, y) && !std::ranges::any_of(leftOut, [&](const Area& area) { return area.holds(x, y); }) &&
          difference(ours, golden, x, y) > WholeWindow::kVisible)
        ++(picture.holds(x, y) ? d.viewport : d.panel);
  return d;
}

std::filesystem::path goldenWindow(const std::string& name) {
  return sourceFolder() / "tests/golden" / (name + ".png");
}

class WholeWindowTest : public WindowWalk {
 protected:
  void compare(const std::string& name, std::vector<std::string> more) {
    const char* font = "/usr/share/fonts/opentype/inter/Inter-Regular.otf";
    if (!std::filesystem::exists(font)) GTEST_SKIP() << font << " is not installed: the text is another font's";
    // Solved to less than its rounding, the light would take a sweep more or less from one processor to the next. The
    // panels tell of sweeps, and of settings that are not the defaults.
    more.insert(more.end(), {"--set", "solver.tolerance=1e-3", "--set", "solver.sweeps_per_frame=4"});
    start(settings(more));
    rests();
    act("mousemove 1500 900");  // out of the picture
    rests();
    const ScreenPart ours = screen_->grab(0, 0, WholeWindow::kWidth, WholeWindow::kHeight);
    const bool bless = std::getenv("IRAD_BLESS") != nullptr;
    if (bless) writePng(goldenWindow(name), ours);
    Area cost = control("Settings/cost").area;
    cost.width = picture().x - cost.x - 20;
    const WholeWindow d = compareWhole(ours, readPng(goldenWindow(name)), picture(), {cost});
    if (!d.within()) {
      const std::filesystem::path saved = buildFolder() / "test-results/window_walk";
      std::filesystem::create_directories(saved);
      writePng(saved / (name + ".ours.png"), ours);
      ADD_FAILURE() << name << ": " << d.panel << " pixels of the panels and " << d.viewport
                    << " of the viewport differ; ours: " << saved / (name + ".ours.png");
    }
    quit();
  }
};

TEST_F(WholeWindowTest, AtFirst) {
  compare("window.first", {});
}

TEST_F(WholeWindowTest, WithTheInspector) {
  fold(R"(["Accuracy", "Lights", "Cameras", "View", "Compare", "Solver", "Memory"])");
  // A voxel none of whose values is within 1e-4 of rounding otherwise, but for its area, which no driver computes.
  compare("window.inspector", {"--inspect", "7,1,13"});
}

TEST(WholeWindow, AMovedWordIsSeen) {
  const ScreenPart golden = readPng(goldenWindow("window.first"));
  ScreenPart moved = golden;
  for (int y = 40; y < 60; ++y)  // the title of the first panel, a pixel to the right
    for (int x = 100; x > 40; --x)
      for (int c = 0; c < 3; ++c) moved.at(x, y, c) = golden.at(x - 1, y, c);
  const Area nowhere{WholeWindow::kWidth, WholeWindow::kHeight, 0, 0};
  EXPECT_TRUE(compareWhole(golden, golden, nowhere).within());
  EXPECT_FALSE(compareWhole(moved, golden, nowhere).within()) << compareWhole(moved, golden, nowhere).panel;
}

}  // namespace
}  // namespace irad::test::window_walk_suite

#else

TEST(WindowWalk, NotBuilt) {
  GTEST_SKIP() << "built without IRAD_OIIO";
}

#endif
