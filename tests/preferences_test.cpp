// The window's remembered layout: its file, what is wrong with one, and what sizes make of a window.
#include <gtest/gtest.h>

#if IRAD_UI

#include <algorithm>
#include <fstream>
#include <map>

#include "renderer/base/error.h"
#include "tests/support.h"
#include "ui/preferences.h"
#include "ui/presets.h"

namespace irad::test::preferences_suite {
namespace {

TEST(Preferences, ComeBackAsTheyWere) {
  const TemporaryFolder folder;
  const auto file = folder.path / "not/yet/there/window.json";
  EXPECT_EQ(readPreferences(file), Preferences()) << "no file: a first start";
  Preferences p;
  p.sizes = {.left = 321.5f, .right = 200, .bottom = 0};
  p.folded = {"Memory", "Settings"};
  p.scale = 1.5f;
  p.applyByHand = true;
  p.opened("/scenes/a.glb");
  p.opened("/scenes/\"b\".glb");
  writePreferences(file, p);
  EXPECT_EQ(readPreferences(file), p);
  p.resetLayout();
  EXPECT_EQ(p.sizes, PanelSizes());
  EXPECT_EQ(p.scale, 0);
  EXPECT_EQ(p.folded, Preferences().folded);
  EXPECT_EQ(p.recent.size(), 2u);
}

TEST(Preferences, RecentScenesAreEachOnceTheLastFirst) {
  Preferences p;
  for (int i = 0; i < 12; ++i) p.opened("/s/" + std::to_string(i) + ".glb");
  p.opened("/s/./9.glb");
  ASSERT_EQ(p.recent.size(), 8u);
  EXPECT_EQ(p.recent[0], "/s/9.glb");
  EXPECT_EQ(p.recent[1], "/s/11.glb");
  EXPECT_EQ(std::count(p.recent.begin(), p.recent.end(), "/s/9.glb"), 1);
}

TEST(Preferences, BadFilesAreNamedWithMemberAndValue) {
  const TemporaryFolder folder;
  const auto file = folder.path / "window.json";
  const std::pair<const char*, std::vector<std::string>> bad[] = {
      {"{\"format\": 1, \"left\": -3}", {"left", "-3"}},
      {"{\"format\": 1, \"bottom\": \"wide\"}", {"bottom", "wide"}},
      {"{\"format\": 1, \"right\": 1e39}", {"right", "1e+39"}},
      {"{\"format\": 1, \"apply_by_hand\": 1}", {"apply_by_hand", "1"}},
      {"{\"format\": 1, \"scale\": 9}", {"scale", "9"}},
      {"{\"format\": 1, \"scale\": \"big\"}", {"scale", "big"}},
      {"{\"format\": 1, \"folded\": [7]}", {"folded", "7"}},
      {"{\"format\": 1, \"recent\": \"x\"}", {"recent", "x"}},
      {"{\"format\": 9}", {"format", "9"}},
      {"{}", {"format", "null"}},
      {"[]", {"an object"}},
      {"{", {"not JSON"}},
  };
  for (const auto& [text, parts] : bad) {
    std::ofstream(file) << text;
    try {
      readPreferences(file);
      FAIL() << text << " was read";
    } catch (const InputError& error) {
      EXPECT_NE(std::string(error.what()).find(file.string()), std::string::npos) << error.what();
      for (const std::string& part : parts)
        EXPECT_NE(std::string(error.what()).find(part), std::string::npos) << text << ": " << error.what();
    }
  }
}

TEST(Preferences, FolderFollowsTheXdgSpecification) {
  const char* names[] = {"XDG_CONFIG_HOME", "HOME"};
  std::map<std::string, std::string> before;
  for (const char* name : names)
    if (const char* value = getenv(name)) before[name] = value;
  setenv("HOME", "/home/u", 1);
  unsetenv("XDG_CONFIG_HOME");
  EXPECT_EQ(preferencesFile(), "/home/u/.config/irad/window.json");
  setenv("XDG_CONFIG_HOME", "relative", 1);
  EXPECT_EQ(preferencesFile(), "/home/u/.config/irad/window.json");
  setenv("XDG_CONFIG_HOME", "/etc/u", 1);
  EXPECT_EQ(preferencesFile(), "/etc/u/irad/window.json");
  unsetenv("XDG_CONFIG_HOME");
  unsetenv("HOME");
  EXPECT_EQ(preferencesFile(), "");
  for (const auto& [name, value] : before) setenv(name.c_str(), value.c_str(), 1);
}

TEST(Presets, AreSavedListedAndAppliedUnderTheirNames) {
  const TemporaryFolder folder;
  const auto apply = [](Settings& settings, const std::filesystem::path& file) {
    if (slurp(file).find("\"matrix.rays\": 77") == std::string::npos) throw InputError(file.string() + ": other rays");
    settings.matrix.gpu.rays = 77;
  };
  Presets presets(folder.path / "presets", apply);
  EXPECT_TRUE(presets.names().empty());
  Settings settings;
  settings.matrix.gpu.rays = 77;
  EXPECT_EQ(presets.save("my set-up_2", settings), folder.path / "presets" / "my set-up_2.json");
  settings.matrix.gpu.rays = 5;
  presets.save("another", settings);
  EXPECT_EQ(presets.names(), (std::vector<std::string>{"another", "my set-up_2"}));
  EXPECT_EQ(Presets(folder.path / "presets", apply).names(), presets.names()) << "not found again";
  presets.apply(settings, "my set-up_2");
  EXPECT_EQ(settings.matrix.gpu.rays, 77u);
  EXPECT_THROW(presets.apply(settings, "another"), InputError);
  EXPECT_EQ(settings.matrix.gpu.rays, 77u) << "a preset that cannot be read changed the settings";

  for (const char* name : {"", " ", "../up", "a/b", "thesis", "dot.", "end "})
    EXPECT_THROW(presets.save(name, settings), UsageError) << name;
  EXPECT_THROW(Presets({}, apply).save("x", settings), WorkError);
}

TEST(Layout, TilesTheWindowWhateverTheSizes) {
  for (const glm::uvec2 window : {glm::uvec2(1280, 720), {2560, 1440}, {700, 500}, {64, 48}, {1, 1}})
    for (const float scale : {1.0f, 2.0f})
      for (const auto& [sizes, folding] :
           {std::pair(PanelSizes{}, Folding{}), std::pair(PanelSizes{1, 1, 1}, Folding{.strip = true}),
            std::pair(PanelSizes{4000, 4000, 4000}, Folding{}),
            std::pair(PanelSizes{500, 0, 300}, Folding{.left = true}),
            std::pair(PanelSizes{4000, 4000, 4000}, Folding{.left = true, .right = true, .strip = true})}) {
        const Layout l = layout(window, scale, Filling::Panels, sizes, folding);
        const glm::vec2 size(window);
        EXPECT_FLOAT_EQ(l.left.size.x + l.viewport.size.x + l.right.size.x, size.x);
        EXPECT_FLOAT_EQ(l.bar.size.y + l.viewport.size.y + l.bottom.size.y, size.y);
        EXPECT_EQ(l.viewport.position, glm::vec2(l.left.size.x, l.bar.size.y));
        EXPECT_EQ(l.right.position.x, l.viewport.position.x + l.viewport.size.x);
        EXPECT_EQ(l.bottom.position.y, l.viewport.position.y + l.viewport.size.y);
        EXPECT_GE(l.viewport.size.x, 0.2f * size.x - 1);
        EXPECT_GE(l.viewport.size.y, 0.2f * size.y - 1);
      }
  EXPECT_EQ(layout({1280, 720}, 1, Filling::Panels, {.left = 250}).left.size.x, 250);
  EXPECT_EQ(layout({2560, 1440}, 2, Filling::Panels, {.bottom = 200}).bottom.size.y, 400);
}

TEST(Layout, GivesThePictureHalfOfTheWindowAtFirstAndMoreOnceFolded) {
  const auto share = [](glm::uvec2 window, float scale, Filling filling, const Folding& folding) {
    const glm::vec2 picture = layout(window, scale, filling, {}, folding).viewport.size;
    return picture.x * picture.y / static_cast<float>(window.x * window.y);
  };
  const Folding first = Preferences().folding();
  EXPECT_TRUE(first.strip);
  EXPECT_FALSE(first.left || first.right);
  for (const glm::uvec2 window : {glm::uvec2(1280, 720), {1600, 900}, {1920, 1080}, {2560, 1440}}) {
    EXPECT_GE(share(window, 1, Filling::Panels, first), 0.5f) << window.x;
    EXPECT_GT(share(window, 1, Filling::Panels, {true, true, true}), 0.9f) << window.x;
    EXPECT_GT(share(window, 1, Filling::Picture, first), 0.95f) << window.x;
    EXPECT_EQ(share(window, 1, Filling::PictureAlone, first), 1) << window.x;
  }
}

}  // namespace
}  // namespace irad::test::preferences_suite

#else
TEST(Preferences, NotBuilt) {
  GTEST_SKIP() << "built without IRAD_UI";
}
#endif
