// A walk through the whole window: every view of the combo against the headless program's picture, every panel and a
// control in each, the window as a whole against pictures that a person has looked at.
#include <gtest/gtest.h>

#if IRAD_OIIO

#include <algorithm>
#include <nlohmann/json.hpp>

#include "gi/views.h"
#include "renderer/scene/light_json.h"
#include "tests/png.h"
#include "tests/window_fixture.h"
#include "ui/panel.h"

namespace irad::test {
namespace {

/// Where things are in a window of 1280 x 720 (ui/layout.h, ui/theme.cpp), pixels.
constexpr int kLeft = 332, kTop = 30, kWidth = 667, kHeight = 503;  ///< the viewport
constexpr int kLine = 19, kFramed = 25;                             ///< from one line of text, one widget to the next
constexpr int kHeader = 26;                                         ///< from one panel's header to the next, all folded
constexpr int kRightColumn = 1140;                                  ///< x of the middle of it

struct Area {
  int x, y, width, height;
  bool holds(int px, int py) const { return px >= x && px < x + width && py >= y && py < y + height; }
};
/// Where the legend of a view with a range may lie, of the viewport (ui/overlays/legend.cpp).
constexpr Area kLegend{358, 390, 296, 100};

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
Apart apart(const ScreenPart& a, const ScreenPart& b, const Area& leftOut = {}) {
  Apart d;
  for (int y = 0; y < a.height; ++y)
    for (int x = 0; x < a.width; ++x) {
      const int most = leftOut.holds(x, y) ? 0 : difference(a, b, x, y);
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
  static std::vector<std::string> settings(const std::vector<std::string>& more = {}) {
    std::vector<std::string> words{"--set", "voxel.resolution=16", "--set", "matrix.rays=32",
                                   "--set", "specular.mode=off",   "--set", "solver.tolerance=1e-6"};
    words.insert(words.end(), more.begin(), more.end());
    return words;
  }
  /// Pictures of the headless program at the viewport's size: VIEW.png.
  std::filesystem::path render(const std::string& views, const std::vector<std::string>& more) {
    const std::filesystem::path out = folder_.path / fmt::format("headless.{}", renders_++);
    std::vector<std::string> command = settings(more);
    command.insert(command.begin(), {"render", (assets() / "box.glb").string(), "--view", views, "--size",
                                     fmt::format("{}x{}", kWidth, kHeight), "--out", out.string()});
    const RunResult result = runIrad(command);
    EXPECT_EQ(result.status, 0) << result.err;
    return out;
  }
  ScreenPart picture() const { return screen_->grab(kLeft, kTop, kWidth, kHeight); }
  /// In time the viewport shows the headless picture: bit for bit, but where H is seen to its rounding in one pixel of
  /// a thousand. The legend of views with a range is left out.
  bool shows(const std::filesystem::path& folder, const ViewInfo& view) {
    const ScreenPart wanted = readPng(folder / (view.name + std::string(".png")));
    Apart d;
    for (const auto end = Clock::now() + std::chrono::seconds(20); Clock::now() < end; pause(0.05)) {
      d = apart(picture(), wanted, view.hasRange() ? kLegend : Area{});
      if (d.most <= kRounding && d.pixels <= kWidth * kHeight / 1000) return true;
    }
    ADD_FAILURE() << view.name << ": " << d.pixels << " pixels differ, by at most " << d.most << " of 255";
    return false;
  }
  /// In time the viewport is as wanted.
  bool becomes(const std::function<bool(const ScreenPart&)>& wanted) {
    for (const auto end = Clock::now() + std::chrono::seconds(20); Clock::now() < end; pause(0.05))
      if (wanted(picture())) return true;
    return false;
  }
  ScreenPart column(Region region) const {
    return region == Region::Left ? screen_->grab(0, kTop, kLeft, 690) : screen_->grab(999, kTop, 281, 690);
  }
  std::filesystem::path preferencesFile() const {
    return std::filesystem::path(screen_->environment().at("XDG_CONFIG_HOME")) / "irad/window.json";
  }

  /// Waits until the window has nothing more to do, nor the server for it.
  void rests() {
    const auto asleep = [this] { return std::pair(screen_->server().asleep(), window_->asleep()); };
    for (const auto end = Clock::now() + std::chrono::seconds(30); Clock::now() < end && window_->running();) {
      const auto before = asleep();
      pause(0.1);
      if (before.first && before.second && asleep() == before) return;
    }
    FAIL() << "the window does not come to rest";
  }
  void click(int x, int y) {
    xdotool(fmt::format("mousemove {} {} sleep 0.1 mousedown 1 sleep 0.1 mouseup 1", x, y));
    rests();
  }
  /// Mouse where it is over nothing, in the menu bar; its picture ends above the viewport.
  void rest() {
    xdotool("mousemove 700 6");
    rests();
  }
  /// Into a slider or a drag field.
  void typeInto(int x, int y, const std::string& text) {
    xdotool(fmt::format("mousemove {} {} keydown ctrl sleep 0.2 mousedown 1 sleep 0.2 mouseup 1 keyup ctrl", x, y));
    rests();
    xdotool("type --delay 60 " + text);
    xdotool("keydown Return sleep 0.2 keyup Return");
    rest();
  }
  /// Unfolds a panel, or folds it again, all others being folded; y of its contents' first pixel.
  int unfold(const std::string& title) {
    int left = 0, right = 0;
    for (const auto& panel : makePanels()) {
      int& place = panel->region() == Region::Left ? left : right;
      if (panel->title() == title) {
        click(panel->region() == Region::Left ? 166 : kRightColumn, kTop + 18 + kHeader * place);
        return kTop + 8 + kHeader * (place + 1);
      }
      ++place;
    }
    ADD_FAILURE() << "no panel " << title;
    return 0;
  }
  void chooseInCombo(View view);
  void quit() {
    rest();
    key("Escape");
    EXPECT_EQ(window_->wait(20), 0) << "status after Esc, with validation on";
  }

 private:
  int renders_ = 0;
};

/// The combo of the View panel, which is on top of the right column: its list holds the views under the headings of
/// their groups, 20 lines of it at a time.
void WindowWalk::chooseInCombo(View wanted) {
  std::vector<std::string> groups;
  for (const ViewInfo& view : views())
    if (std::find(groups.begin(), groups.end(), view.group) == groups.end()) groups.emplace_back(view.group);
  int line = 0, lines = 0;
  for (const std::string& group : groups) {
    ++lines;
    for (const ViewInfo& view : views()) {
      if (group != view.group) continue;
      if (view.view == wanted) line = lines;
      ++lines;
    }
  }
  constexpr int kList = 85, kPadding = 8, kWheel = 70, kListHeight = 20 * kLine - 5 + 2 * kPadding;
  const int most = std::max(lines * kLine - 5 + 2 * kPadding - kListHeight, 0);
  const int turns = (std::max(line * kLine - kListHeight / 2, 0) + kWheel - 1) / kWheel;
  const int scrolled = std::min(turns * kWheel, most);
  click(kRightColumn, 74);
  const int y = kList + kPadding + line * kLine + kLine / 2 - scrolled;
  // To the top first: turns back and forth within one frame would be added up.
  xdotool(fmt::format("mousemove {} {} click --repeat 20 --delay 1 4", kRightColumn, kList + 100));
  rests();
  if (turns > 0) xdotool(fmt::format("click --repeat {} --delay 1 5", turns));
  rests();
  click(kRightColumn, y);
}

TEST_F(WindowWalk, EveryViewIsTheHeadlessPicture) {
  fold(R"(["Scene", "Cameras", "Settings", "Compare", "Inspector", "Solver", "Memory"])");
  const std::vector<std::string> withReference{
      "--reference", (std::filesystem::path(IRAD_SOURCE_DIR) / "tests/golden/box.main.lit.exr").string()};
  start(settings(withReference));
  const std::filesystem::path headless = render("all", withReference);
  rests();
  click(20, 149);  // no handles of lights over the picture
  rest();
  for (const ViewInfo& view : views()) {
    if (view.view < 9)
      key(std::to_string(view.view + 1));
    else
      chooseInCombo(view.view);
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
  // No handles of lights in the picture.
  click(20, unfold("Lights") + kFramed + kLine + 5 + 10);
  unfold("Lights");
  rest();
  const ScreenPart left = column(Region::Left), right = column(Region::Right);
  const ScreenPart first = picture();
  const auto comesBack = [&] {
    return becomes([&](const ScreenPart& p) { return apart(p, first).most <= kRounding; });
  };

  // Every panel there is: unfolded it shows something, folded again it leaves no trace.
  for (const auto& panel : makePanels()) {
    if (panel->region() == Region::Bottom) continue;
    const ScreenPart folded = panel->region() == Region::Left ? left : right;
    unfold(panel->title());
    rest();
    EXPECT_GT(column(panel->region()).difference(folded), 0.005) << panel->title() << " is empty";
    unfold(panel->title());
    rest();
    EXPECT_EQ(column(panel->region()), folded) << panel->title();
  }

  // Scene: a path.
  int top = unfold("Scene");
  click(150, top + 7 * kLine + 10);
  xdotool("type --delay 60 walk.glb");
  xdotool("keydown Return sleep 0.3 keyup Return");
  const auto opened = [&](const ScreenPart& p) { return p == first && contains(slurp(preferencesFile()), "walk.glb"); };
  EXPECT_TRUE(becomes(opened)) << "the scene typed is not opened";
  unfold("Scene");

  // Lights: the intensity of the one there is, typed; and taken back.
  key("3");
  top = unfold("Lights");
  click(60, top + kFramed + kLine / 2);  // the light
  rest();
  const ScreenPart direct = picture();
  typeInto(240, top + 5 * kFramed + kLine + 5 + 10, "3000");
  std::vector<Light> lights = loadScene(assets() / "box.glb").lights;
  lights.at(0).intensity = 3000;
  EXPECT_TRUE(shows(render("direct", {"--lights", lightsToJson(lights)}), *viewInfo(VIEW_DIRECT)));
  click(84, top + 13 * kFramed + kLine + 5 + 10);  // Revert
  EXPECT_TRUE(becomes([&](const ScreenPart& p) { return p == direct; })) << "not reverted";
  // And dragged: the intensity to the right by half of the field, a hundredth of itself a pixel; the position.
  const auto drag = [&](int y, int pixels) {
    xdotool(fmt::format("mousemove 200 {0} sleep 0.3 mousedown 1 sleep 0.3 mousemove {1} {0} sleep 0.3 mouseup 1", y,
                        200 + pixels));
    rest();
  };
  drag(top + 5 * kFramed + kLine + 5 + 10, 70);
  EXPECT_GT(picture().meanLuminance(), 1.05 * direct.meanLuminance()) << "the intensity is not dragged";
  drag(top + 9 * kFramed + kLine + 5 + 10, -60);
  const ScreenPart brighter = picture();
  EXPECT_GT(brighter.difference(direct), 0.1);
  click(84, top + 13 * kFramed + kLine + 5 + 10);  // Revert
  EXPECT_TRUE(becomes([&](const ScreenPart& p) { return p == direct; })) << "dragged values are not reverted";
  unfold("Lights");

  // Cameras: a bookmark of where one has flown to, beside the scene's two.
  top = unfold("Cameras");
  xdotool("keydown w sleep 0.3 keyup w");
  rests();
  const ScreenPart flown = picture();
  EXPECT_GT(flown.difference(direct), 0.1);
  click(60, top + 2 * kLine + 5 + 10);
  click(60, top + kLine / 2);
  EXPECT_TRUE(becomes([&](const ScreenPart& p) { return p == direct; })) << "the scene's camera";
  click(60, top + 2 * kLine + kLine / 2);
  EXPECT_TRUE(becomes([&](const ScreenPart& p) { return p == flown; })) << "the bookmark";
  click(60, top + kLine / 2);
  unfold("Cameras");

  // Settings: voxel.resolution, typed.
  key("1");
  top = unfold("Settings");
  const int resolution = top + kFramed + 2 * kLine + 10;
  typeInto(220, resolution, "24");
  EXPECT_TRUE(shows(render("lit", {"--set", "voxel.resolution=24"}), *viewInfo(VIEW_LIT)));
  typeInto(220, resolution, "16");
  unfold("Settings");
  EXPECT_TRUE(comesBack()) << "16 voxels again";

  // View: range and colour map of depth.
  key("9");
  top = unfold("View");
  click(1180, top + kFramed + kLine + 10);
  click(1180, top + kFramed + kLine + 20 + 8 + 2 * kLine + kLine / 2);  // percentile
  click(1180, top + 4 * kFramed + 2 * kLine + 10);
  click(1180, top + 4 * kFramed + 2 * kLine + 20 + 8 + 2 * kLine + kLine / 2);  // grey
  EXPECT_TRUE(shows(render("depth", {"--set", "view.range=percentile", "--set", "view.color_map=grey"}),
                    *viewInfo(VIEW_DEPTH)));
  unfold("View");
  key("1");
  EXPECT_TRUE(comesBack()) << "lit again";

  // Compare: the same settings on both sides differ in the letters and the line only.
  top = unfold("Compare");
  click(kRightColumn, top + 10);
  const auto compared = [&](const ScreenPart& p) { return p != first && p.difference(first) < 0.01; };
  EXPECT_TRUE(becomes(compared)) << "no comparison";
  click(kRightColumn, 376);
  EXPECT_TRUE(comesBack()) << "the comparison does not end";
  unfold("Compare");

  // Inspector: a click on the floor, a filter that nothing passes, done.
  unfold("Inspector");
  click(600, 490);
  const auto table = [this] { return screen_->grab(1005, 630, 230, 80); };
  EXPECT_GT(table().deviation(), 0.05) << "no links";
  click(1100, 592);
  xdotool("type --delay 60 zzz");
  rest();
  EXPECT_LT(table().deviation(), 0.02) << "not filtered: only the lines between columns are left";
  click(1078, 151);
  unfold("Inspector");
  EXPECT_TRUE(comesBack()) << "Clear leaves something";

  // Solver: from the dark, a sweep, and on.
  key("4");
  rests();
  const ScreenPart indirect = picture();
  top = unfold("Solver");
  const int buttons = top + 2 * 14 + 5 + 10;
  click(1049, buttons);  // Pause
  click(1228, buttons);  // H = 0
  rests();
  const ScreenPart dark = picture();
  EXPECT_LT(dark.meanLuminance(), 0.2 * indirect.meanLuminance());
  click(1139, buttons);  // Step
  rests();
  EXPECT_GT(picture().meanLuminance(), dark.meanLuminance());
  EXPECT_LT(picture().meanLuminance(), indirect.meanLuminance());
  click(1049, buttons);  // Resume
  EXPECT_TRUE(becomes([&](const ScreenPart& p) { return apart(p, indirect).most <= kRounding; }));
  unfold("Solver");

  // Memory: its table as a file.
  top = unfold("Memory");
  click(kRightColumn, top + 12 + 2 * kLine + 10);
  EXPECT_TRUE(says("Saved "));
  unfold("Memory");

  // Timings: values of two frames under the mouse; every tab, and a record of a second.
  const auto window = [this] { return screen_->grab(0, 0, 1280, 720); };
  rest();
  const ScreenPart unread = window();
  std::vector<ScreenPart> readings;
  for (const int x : {700, 950}) {
    xdotool(fmt::format("mousemove {} 600", x));
    rests();
    readings.push_back(window());
    EXPECT_GT(readings.back().difference(unread), 0.005) << "nothing is read at " << x;
  }
  EXPECT_GT(readings[0].difference(readings[1]), 0.005);
  rest();
  const auto strip = [this] { return screen_->grab(340, 570, 650, 140); };
  ScreenPart before = strip();
  for (const int tab : {407, 469, 541, 359}) {
    click(tab, 552);
    EXPECT_GT(strip().difference(before), 0.01) << "tab at " << tab;
    before = strip();
  }
  xdotool("mousemove 945 552 sleep 0.3 mousedown 1 sleep 0.3 mouseup 1 sleep 1 mousedown 1 sleep 0.3 mouseup 1");
  EXPECT_TRUE(says("Recorded "));
  quit();
}

/// Settings with which the scene is read anew, and what a pixel looks for itself.
TEST_F(WindowWalk, SettingsOfTheSceneAndOfEmittersAreDrawnAtOnce) {
  // Of the panels only Settings is unfolded, of its groups only the last, `scene`.
  std::vector<std::string> folded;
  for (const auto& panel : makePanels())
    if (panel->title() != std::string("Settings")) folded.emplace_back(panel->title());
  std::vector<std::string> groups;
  Settings all;
  visit(all, [&](auto&&, const Meta& meta) {
    const std::string name = meta.name, group = name.substr(0, name.find('.'));
    if (groups.empty() || groups.back() != group) groups.push_back(group);
  });
  ASSERT_EQ(groups.back(), "scene");
  for (const std::string& group : groups)
    if (group != "scene") folded.push_back("Settings/" + group);
  fold(nlohmann::json(folded).dump().c_str());
  start(settings());
  rests();
  click(20, unfold("Lights") + kFramed + kLine + 5 + 10);  // no handles in the picture
  unfold("Lights");
  const auto header = [&](const std::string& group) {
    const auto above = std::find(groups.begin(), groups.end(), group) - groups.begin();
    return kTop + 8 + 4 * kHeader + kFramed + static_cast<int>(above + 1) * kLine + kLine / 2;
  };
  const auto row = [&](const std::string& group, int i) { return header(group) + kLine + 3 + i * kFramed; };
  const ViewInfo& lit = *viewInfo(VIEW_LIT);

  click(151, row("scene", 1));  // double sided
  rest();
  EXPECT_TRUE(shows(render("lit", {"--set", "scene.double_sided=true"}), lit));
  click(151, row("scene", 1));
  rest();
  EXPECT_TRUE(shows(render("lit", {}), lit));
  click(60, header("scene"));

  click(60, header("sample"));
  const int emitters = row("sample", 4);
  click(220, emitters);
  click(220, emitters + 18 + kLine + kLine / 2);  // pixels
  rest();
  EXPECT_TRUE(shows(render("lit", {"--set", "sample.emitters=pixels"}), lit));
  quit();
}

/// The whole window against pictures of it that a person has looked at. After a change that is meant:
///
///   IRAD_BLESS=1 build/tests/window_walk_test --gtest_filter='*Whole*'    (then look at them)
///
/// Of panels and menus no more pixels may differ visibly (by more than a sixteenth) than a digit or two have: room for
/// another rounding of a value. A word that moves by a pixel differs in more (AMovedWordIsSeen). The pictures in the
/// viewport are compared elsewhere; here one pixel in a hundred may differ, which edges on another driver need. Times
/// and the plot of them are left out.
struct WholeWindow {
  static constexpr int kWidth = 1280, kHeight = 720, kVisible = 16, kPanelPixels = 60;
  static constexpr Area kViewport{332, 30, 667, 503}, kTimes{332, 562, 667, 158};

  int panel = 0, viewport = 0;  ///< pixels that differ visibly
  bool within() const { return panel <= kPanelPixels && viewport <= kViewport.width * kViewport.height / 100; }
};
WholeWindow compareWhole(const ScreenPart& ours, const ScreenPart& golden) {
  WholeWindow d;
  for (int y = 0; y < WholeWindow::kHeight; ++y)
    for (int x = 0; x < WholeWindow::kWidth; ++x)
      if (!WholeWindow::kTimes.holds(x, y) && difference(ours, golden, x, y) > WholeWindow::kVisible)
        ++(WholeWindow::kViewport.holds(x, y) ? d.viewport : d.panel);
  return d;
}

std::filesystem::path goldenWindow(const std::string& name) {
  return std::filesystem::path(IRAD_SOURCE_DIR) / "tests/golden" / (name + ".png");
}

class WholeWindowTest : public WindowWalk {
 protected:
  void compare(const std::string& name, std::vector<std::string> more) {
    const char* font = "/usr/share/fonts/opentype/inter/Inter-Regular.otf";
    if (!std::filesystem::exists(font)) GTEST_SKIP() << font << " is not installed: the text is another font's";
    // Solved to less than its rounding, the light would take a sweep more or less from one processor to the next.
    more.insert(more.end(), {"--set", "solver.tolerance=1e-3"});
    start(settings(more));
    rests();
    xdotool("mousemove 1500 900");  // out of the picture
    rests();
    const ScreenPart ours = screen_->grab(0, 0, WholeWindow::kWidth, WholeWindow::kHeight);
    const bool bless = std::getenv("IRAD_BLESS") != nullptr;
    if (bless) writePng(goldenWindow(name), ours);
    const WholeWindow d = compareWhole(ours, readPng(goldenWindow(name)));
    if (!d.within()) {
      const std::filesystem::path saved = std::filesystem::path(IRAD_BINARY).parent_path() / "test-results/window_walk";
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
  fold(R"(["Lights", "Cameras", "View", "Compare", "Solver", "Memory"])");
  // A voxel none of whose values is within 1e-4 of rounding otherwise, but for its area, which no driver computes.
  compare("window.inspector", {"--inspect", "7,1,13"});
}

TEST(WholeWindow, AMovedWordIsSeen) {
  const ScreenPart golden = readPng(goldenWindow("window.first"));
  ScreenPart moved = golden;
  for (int y = 40; y < 60; ++y)  // the title of the first panel, a pixel to the right
    for (int x = 100; x > 40; --x)
      for (int c = 0; c < 3; ++c) moved.at(x, y, c) = golden.at(x - 1, y, c);
  EXPECT_TRUE(compareWhole(golden, golden).within());
  EXPECT_FALSE(compareWhole(moved, golden).within()) << compareWhole(moved, golden).panel;
}

}  // namespace
}  // namespace irad::test

#else

TEST(WindowWalk, NotBuilt) {
  GTEST_SKIP() << "built without IRAD_OIIO";
}

#endif
