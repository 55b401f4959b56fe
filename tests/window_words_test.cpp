// The window's words: the search for settings, the glossary, and what views say that have nothing to be drawn from.
#include "tests/window_fixture.h"

namespace irad::test::window_words_suite {
namespace {

class WindowWordsTest : public WindowTest {
 protected:
  /// With these panels folded, beside those that no test here needs.
  void begin(const char* folded, std::vector<std::string> more) {
    fold(fmt::format(
             R"(["Accuracy", "Scene", "Effects", "Materials", "Inspector", "Compare", "Solver", "Memory", "Timings",
                         "History", "Cameras", {}])",
             folded)
             .c_str());
    start(std::move(more));
    rests();
  }
};

TEST_F(WindowWordsTest, SettingsAreFoundByWordsAndByChange) {
  // One that is soon made anew, and one that the group of it is not reset with.
  begin(R"("Lights", "View", "Settings")", {"--set", "light.shadow_resolution=256"});
  // The keys go to the search, also of a panel that is folded.
  key("ctrl+f");
  ASSERT_TRUE(appears("Settings/search"));
  rests();
  type("relaxation");
  EXPECT_TRUE(appears("Settings/solver.omega")) << "not found by its meaning";
  // Where its slider stands is marked below the number, in the colour of what is chosen.
  const Control::Area slider = control("Settings/solver.omega").area;
  const ScreenPart pixels = screen_->grab(slider.x, slider.y, slider.width, slider.height);
  int above = 0, below = 0;
  for (int y = 0; y < pixels.height; ++y)
    for (int x = 0; x < pixels.width; ++x)
      if (pixels.at(x, y, 0) > pixels.at(x, y, 2) + 60) ++(4 * y < 3 * pixels.height ? above : below);
  EXPECT_GT(below, 8) << "it is not marked";
  EXPECT_EQ(above, 0) << "the mark covers the number";
  EXPECT_FALSE(has("Settings/voxel.resolution"));
  enter("Settings/search", "resolution");
  EXPECT_TRUE(appears("Settings/voxel.resolution"));
  EXPECT_FALSE(has("Settings/solver.omega"));
  enter("Settings/search", "");
  // What is not this device's default; a group goes back to it at once.
  click("Settings/changed");
  EXPECT_TRUE(appears("Settings/light.shadow_resolution"));
  EXPECT_FALSE(has("Settings/solver.omega"));
  click("Settings/light/reset");
  EXPECT_TRUE(appears("Settings/light.shadow_resolution", /*wanted=*/false)) << "the group is not reset";
  EXPECT_TRUE(has("Settings/voxel.resolution")) << "another group is";
  key("ctrl+z");
  EXPECT_TRUE(appears("Settings/light.shadow_resolution")) << "it is no step";
  rests();
  // The glossary, and away with it.
  choose("Menu/Help", "Glossary");
  EXPECT_TRUE(appears("glossary/Close"));
  key("Escape");
  EXPECT_TRUE(appears("glossary/Close", /*wanted=*/false));
  quit();
}

TEST_F(WindowWordsTest, ViewsWithoutInputSaySoAndOfferIt) {
  begin(R"("Settings")", {"--view", "error", "--set", "solver.frames=2"});
  // A file is missing: the button opens the dialog, which lies over what the picture says.
  ASSERT_TRUE(appears("missing/mend")) << "nothing says why the picture is black";
  click("missing/mend");
  EXPECT_TRUE(appears("Open a scene/Cancel"));
  EXPECT_FALSE(has("missing/mend"));
  click("Open a scene/Cancel");
  EXPECT_TRUE(appears("missing/mend"));
  // A setting is in the way: the button sets it.
  choose("View/view", "standard-error");
  click("missing/mend");
  EXPECT_TRUE(appears("missing/mend", /*wanted=*/false));
  // Colours that are places have a legend.
  choose("View/view", "jfa-seeds");
  EXPECT_TRUE(appears("legend"));
  // A light is off: the button turns it on.
  choose("View/view", "shadow-map");
  EXPECT_TRUE(appears("missing/mend", /*wanted=*/false));
  click("Lights/0");
  click("Lights/0/on");
  click("missing/mend");
  EXPECT_TRUE(appears("missing/mend", /*wanted=*/false));
  EXPECT_TRUE(isOn("Lights/0/on"));
  quitDiscarding();
}

}  // namespace
}  // namespace irad::test::window_words_suite
