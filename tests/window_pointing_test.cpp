// What is under the mouse, the picture's pixels shown large, the histogram with the ends of the range.
#include <algorithm>

#include "tests/window_fixture.h"

namespace irad::test::window_pointing_suite {
namespace {

class WindowPointingTest : public WindowTest {
 protected:
  void begin(std::vector<std::string> more = {}) {
    fold(R"(["Accuracy", "Scene", "Effects", "Inspector", "Compare", "Solver", "Memory", "Lights", "Materials"])");
    start(std::move(more));
    away();
    ASSERT_TRUE(viewportSettles(lit));
  }
  /// What the status line says; empty: nothing of that name.
  std::string reading(const std::string& name) const {
    for (const Control& c : controls())
      if (c.name.starts_with("Pointing/" + name + "=")) return c.name.substr(c.name.find('=') + 1);
    return "";
  }
  void point(const std::string& place) {
    act("mousemove " + place);
    rests();
  }
  void undo() {
    away();
    key("ctrl+z");
    rests();
  }
};

TEST_F(WindowPointingTest, ALineSaysWhatIsUnderTheMouse) {
  begin({"--view", "albedo"});
  const Control::Area p = picture();
  const std::string wall = at(-488, -63);
  const int x = std::stoi(wall) - p.x, y = std::stoi(wall.substr(wall.find(' '))) - p.y;
  point(wall);
  EXPECT_EQ(reading("pixel"), fmt::format("x {} y {}", x, y));
  EXPECT_EQ(reading("material"), "red wall");
  EXPECT_TRUE(reading("facet").starts_with("facet ")) << reading("facet");
  EXPECT_TRUE(reading("voxel").starts_with("voxel ")) << reading("voxel");
  const std::string red = reading("value");
  double r = 0, g = 0;
  std::istringstream(red) >> r >> g;
  EXPECT_GT(r, 3 * g) << red;

  // On the line itself it moves out of the way, and reads on.
  const Control below = control(fmt::format("Pointing/pixel=x {} y {}", x, y));
  point(fmt::format("{} {}", p.x + 268, below.area.y + below.area.height / 2));
  EXPECT_TRUE(reading("pixel").starts_with("x 268 ")) << reading("pixel");
  const std::vector<Control> all = controls();
  const auto line = std::ranges::find_if(all, [](const Control& c) { return c.name.starts_with("Pointing/pixel="); });
  ASSERT_NE(line, all.end());
  EXPECT_LT(line->area.y, 100);

  // With the view's unit; gone where the mouse is elsewhere.
  key("9");
  rests();
  point(wall);
  EXPECT_TRUE(reading("value").ends_with(" m")) << reading("value");
  EXPECT_EQ(reading("material"), "red wall");
  point("10 600");  // in the left column
  EXPECT_EQ(reading("pixel"), "");
  away();
  quit();
}

TEST_F(WindowPointingTest, PixelsAreShownLargeAndToldApart) {
  begin();
  const ScreenPart whole = viewport();
  const Control::Area p = picture();
  const std::string middle = fmt::format("{} {}", p.x + 318, p.y + 260);
  act(fmt::format("mousemove {} keydown ctrl", middle));
  for (int i = 0; i < 5; ++i) {
    act("click 4");
    rests();
  }
  act("keyup ctrl");
  rests();
  EXPECT_EQ(reading("zoom"), "8 \u00D7");
  EXPECT_EQ(reading("pixel"), "x 318 y 260") << "the pixel under the mouse stays";
  point(aside());
  // Squares of 8 pixels of one colour each, wherever they begin.
  const ScreenPart large = viewport();
  size_t best = 0, all = 0;
  for (int begin = 0; begin < 8; ++begin) {
    size_t same = 0;
    all = 0;
    for (int y = 40; y < large.height; y += 3)
      for (int x = begin; x + 7 < large.width; x += 8, ++all) {
        bool one = true;
        for (int c = 0; c < 3; ++c)
          for (int i = 1; i < 8; ++i) one = one && large.at(x, y, c) == large.at(x + i, y, c);
        same += one;
      }
    best = std::max(best, same);
  }
  EXPECT_EQ(best, all) << "pixels are blurred";
  // The middle button moves the picture, by what the mouse moves.
  point(fmt::format("{} {}", p.x + 168, p.y + 270));
  act("mousedown 2");
  point(fmt::format("{} {}", p.x + 184, p.y + 270));
  act("mouseup 2");
  rests();
  point(aside());
  const ScreenPart moved = viewport();
  size_t follows = 0, compared = 0;
  for (int y = 10; y < moved.height; y += 7)
    for (int x = 20; x + 16 < moved.width; x += 9, ++compared) follows += moved.at(x + 16, y, 1) == large.at(x, y, 1);
  EXPECT_EQ(follows, compared);
  // Numbers in the pixels, once there is room for them.
  act(fmt::format("mousemove {} keydown ctrl", middle));
  for (int i = 0; i < 6; ++i) {
    act("click 4");
    rests();
  }
  act("keyup ctrl");
  point(aside());
  EXPECT_EQ(reading("zoom"), "64 \u00D7");
  const ScreenPart numbers = viewport();
  size_t edges = 0, pairs = 0;
  for (int y = 0; y < numbers.height; y += 3)
    for (int x = 0; x + 1 < numbers.width; ++x, ++pairs) edges += numbers.at(x, y, 1) != numbers.at(x + 1, y, 1);
  EXPECT_GT(edges, pairs / 8) << "no numbers: one in 64 at most were the edges of pixels";
  key("0");
  EXPECT_TRUE(viewportSettles([&](const ScreenPart& p) { return p == whole; })) << "not the whole picture again";
  EXPECT_EQ(reading("zoom"), "");
  // A click picks what is seen there.
  zoomAt(at(-488, -63), 2);
  EXPECT_EQ(reading("material"), "red wall");
  key("0");
  rests();
  quit();
}

TEST_F(WindowPointingTest, EndsOfTheRangeAreDraggedOnTheHistogram) {
  begin({"--view", "depth", "--shaders", copyShaders({"gi/gather.comp"}).string()});  // for F5
  const ScreenPart before = viewport();
  click("View/Histogram");
  ASSERT_TRUE(appears("View/histogram/high"));
  EXPECT_TRUE(isOn("View/histogram/plot"));
  EXPECT_FALSE(has("View/view.high")) << "the range is manual from the beginning";
  const auto dragEnd = [&](const std::string& end, int by) {
    point(placeOf(end));
    EXPECT_TRUE(isOn(end)) << "the mouse is not on it";
    drag(end, by);
  };
  dragEnd("View/histogram/high", -40);
  EXPECT_TRUE(appears("View/view.high")) << "it cannot be dragged";
  away();
  EXPECT_TRUE(viewportSettles([&](const ScreenPart& p) { return p.difference(before) > 0.05; })) << "nothing follows";
  dragEnd("View/histogram/low", 30);
  away();
  rests();
  // What is said lies beside the legend, or above it.
  key("F5");
  const Control::Area said = control("messages/0/dismiss").area, legend = control("legend").area;
  EXPECT_TRUE(said.right() <= legend.x || said.bottom() <= legend.y) << "a message covers the legend";
  undo();
  undo();
  EXPECT_TRUE(viewportSettles([&](const ScreenPart& p) { return p == before; })) << "a drag is not one step";
  EXPECT_FALSE(has("View/view.high"));
  // Of light: of each channel, or the luminance; without ends.
  key("1");
  rests();
  EXPECT_TRUE(isOn("View/histogram/channels"));
  EXPECT_FALSE(has("View/histogram/high"));
  click("View/histogram/luminance");
  EXPECT_TRUE(isOn("View/histogram/luminance"));
  away();
  quit();
}

TEST_F(WindowPointingTest, TablesKeepWhatRanAndOneTimeWorkByResolution) {
  begin();
  click("Timings/Table");
  EXPECT_TRUE(appears("Timings/RE Forward=frames"));
  click("Timings/One-time");
  EXPECT_TRUE(appears("Timings/box, 16 voxels"));
  EXPECT_TRUE(has("Timings/GI BuildMatrix=1"));
  click("Timings/Plot");
  away();
  quit();
}

}  // namespace
}  // namespace irad::test::window_pointing_suite
