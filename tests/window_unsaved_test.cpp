// Esc closes and never quits; what is unsaved is asked for before it is lost (docs/conventions.md, "What is unsaved").
#include "renderer/scene/sidecar.h"
#include "tests/window_fixture.h"

namespace irad::test::window_unsaved_suite {
namespace {

class WindowUnsavedTest : public WindowTest {
 protected:
  static constexpr const char* kSave = "Unsaved changes/Save";
  static constexpr const char* kDiscard = "Unsaved changes/Discard";
  static constexpr const char* kCancel = "Unsaved changes/Cancel";

  /// A scene of the test's own, whose sidecar may be written.
  std::filesystem::path ownScene(const char* name = "own.glb") {
    const std::filesystem::path scene = folder_.path / name;
    std::filesystem::copy_file(assets() / "box.glb", scene);
    return scene;
  }
  /// All panels unfolded except those whose controls would have to be scrolled to; the mouse out of the way.
  void begin(std::vector<std::string> more = {}, const std::filesystem::path& scene = assets() / "box.glb") {
    fold(R"(["Accuracy", "Scene", "Objects", "Effects", "Solver", "Memory"])");
    start(std::move(more), scene);
    away();
    ASSERT_TRUE(viewportSettles(lit));
  }
  void escape() { hold("Escape"); }
  bool asks() {
    rests();
    return has(kCancel);
  }
  std::filesystem::path preferences() const {
    return std::filesystem::path(screen_->environment().at("XDG_CONFIG_HOME")) / "irad/window.json";
  }
  std::filesystem::path preset(const std::string& name) const {
    return preferences().parent_path() / "presets" / (name + ".json");
  }
};

TEST_F(WindowUnsavedTest, EscClosesWhatIsOnTopAndNeverQuits) {
  begin();
  // A list; a menu with the one that it opened; the popup of a preset's name, after the field in it.
  click("View/view");
  ASSERT_TRUE(has("View/view/lit"));
  escape();
  EXPECT_FALSE(has("View/view/lit")) << "the list stays";
  choose("Menu/View", "Panels");
  ASSERT_TRUE(has("Menu/View/Panels/Memory"));
  escape();
  EXPECT_FALSE(has("Menu/View/Panels/Memory")) << "the inner menu stays";
  EXPECT_FALSE(has("Menu/View/Reset the layout")) << "the menu stays";
  click("Settings/Save\u2026");
  ASSERT_TRUE(has("Settings/Save\u2026/Save"));
  type("x");
  escape();
  EXPECT_TRUE(has("Settings/Save\u2026/Save")) << "the text field comes first";
  escape();
  EXPECT_FALSE(has("Settings/Save\u2026/Save")) << "the popup stays";
  // The dialog.
  key("o");
  ASSERT_TRUE(appears("Open a scene/Cancel"));
  escape();
  EXPECT_FALSE(has("Open a scene/Cancel")) << "the dialog stays";

  // The inspected facet, the chosen light and the comparison, with the help over them: one after the other.
  click("Compare/Compare with these settings");
  ASSERT_TRUE(appears("Compare/End the comparison"));
  click("Lights/0");
  press(at(-200, 100));  // beside the comparison's line
  ASSERT_TRUE(appears("Inspector/Clear"));
  away();
  const ScreenPart picture = viewport();
  key("F1");
  ASSERT_TRUE(viewportSettles([&](const ScreenPart& p) { return p.difference(picture) > 0.1; })) << "no help";
  escape();
  ASSERT_TRUE(viewportSettles([&](const ScreenPart& p) { return p == picture; })) << "the help stays";
  ASSERT_TRUE(has("Inspector/Clear"));
  escape();
  EXPECT_FALSE(has("Inspector/Clear")) << "the facet stays";
  escape();  // the object that was clicked
  EXPECT_TRUE(isOn("Lights/0"));
  escape();
  EXPECT_FALSE(isOn("Lights/0")) << "the light stays chosen";
  EXPECT_TRUE(has("Compare/End the comparison"));
  escape();
  EXPECT_TRUE(appears("Compare/Compare with these settings")) << "the comparison stays";

  // Nothing is left to close.
  away();
  const ScreenPart closed = viewport();
  for (int i = 0; i < 3; ++i) escape();
  EXPECT_EQ(viewport(), closed);
  ASSERT_TRUE(window_->running());
  quit();
}

TEST_F(WindowUnsavedTest, SettingsAreKeptAsAPresetDiscardedOrStay) {
  begin();
  choose("Settings/sample.filter", "linear");
  key("ctrl+q");
  ASSERT_TRUE(appears(kCancel)) << "settings are lost without being asked for";
  EXPECT_FALSE(has("Unsaved changes/file")) << "no light was edited";
  click(kCancel);
  EXPECT_FALSE(asks());
  ASSERT_TRUE(window_->running());
  key("ctrl+q");
  ASSERT_TRUE(appears(kCancel));
  escape();
  EXPECT_FALSE(asks()) << "Esc is not Cancel";
  ASSERT_TRUE(window_->running());

  // A name that is not allowed is reported; the question stays.
  key("ctrl+q");
  enter("Unsaved changes/preset", "a/b");
  EXPECT_TRUE(asks());
  ASSERT_TRUE(window_->running());
  enter("Unsaved changes/preset", "mine");
  EXPECT_EQ(window_->wait(20), 0);
  EXPECT_TRUE(contains(slurp(preset("mine")), "\"sample.filter\": \"linear\"")) << slurp(preset("mine"));

  // From the preset: nothing is unsaved. Edited again: discarded, under the same name.
  begin();
  choose("Settings/preset", "mine");
  rests();
  quit();
  begin();
  choose("Settings/preset", "mine");
  choose("Settings/sample.filter", "nearest");
  quitDiscarding();
  EXPECT_TRUE(contains(slurp(preset("mine")), "\"sample.filter\": \"linear\""));
}

TEST_F(WindowUnsavedTest, ACaptureKeepsSettingsAndAPickIsNone) {
  begin();
  press(at(0, 100));
  ASSERT_TRUE(appears("Inspector/Clear"));
  choose("Settings/sample.filter", "linear");
  key("F12");
  ASSERT_TRUE(says("Saved Lit"));
  quit();
}

TEST_F(WindowUnsavedTest, TheWindowsCloseButtonAsksForLights) {
  const std::filesystem::path scene = ownScene();
  begin({}, scene);
  click("Lights/point");
  ASSERT_TRUE(closeWindow(screen_->display(), "irad"));
  ASSERT_TRUE(appears(kSave)) << "lights are lost without being asked for";
  EXPECT_FALSE(has("Unsaved changes/preset")) << "no setting was edited";
  click(kSave);
  EXPECT_EQ(window_->wait(20), 0);
  ASSERT_TRUE(std::filesystem::exists(sidecarPath(scene)));
  EXPECT_EQ(readSidecar(sidecarPath(scene)).lights->size(), 2u);
  // Nothing unsaved: at once.
  begin({}, scene);
  ASSERT_TRUE(closeWindow(screen_->display(), "irad"));
  EXPECT_EQ(window_->wait(20), 0);
}

TEST_F(WindowUnsavedTest, AnotherSceneAsksForLightsAndTheSameDoesNot) {
  const std::filesystem::path scene = ownScene(), other = ownScene("other.glb");
  begin({}, scene);
  click("Cameras/Add bookmark");
  const auto opened = [&](const std::filesystem::path& path) {
    rests();
    return contains(slurp(preferences()), path.filename().string());
  };
  // Rows of lists that are out of view are not drawn.
  const auto bookmarked = [&] {
    shown("Cameras/Add bookmark");
    rests();
    return has("Cameras/2");
  };
  // Loaded again it keeps them; settings that read it anew do, too.
  choose("Menu/File", "Load again");
  EXPECT_FALSE(asks());
  EXPECT_TRUE(bookmarked()) << "the bookmark is gone";
  click("Settings/scene.double_sided");
  EXPECT_FALSE(asks());
  click("Settings/scene.double_sided");
  EXPECT_TRUE(bookmarked()) << "the bookmark is gone";

  // By drag and drop, the menu's list and the dialog.
  ASSERT_TRUE(drop({other}));
  ASSERT_TRUE(appears(kCancel)) << "a dropped scene does not ask";
  click(kCancel);
  EXPECT_FALSE(opened(other));
  key("o");
  enter("Open a scene/path", other.string());
  ASSERT_TRUE(appears(kCancel)) << "the dialog does not ask";
  escape();
  EXPECT_FALSE(opened(other));
  EXPECT_TRUE(bookmarked());
  click("Scene");
  enter("Scene/open", other.string());
  ASSERT_TRUE(appears(kSave)) << "the Scene panel does not ask";
  click(kSave);
  EXPECT_TRUE(opened(other));
  EXPECT_EQ(readSidecar(sidecarPath(scene)).bookmarks.size(), 1u);
  EXPECT_FALSE(bookmarked()) << "a bookmark of the other scene";
  click("Cameras/Add bookmark");
  choose("Menu/File", "Open recent");
  click("Menu/File/Open recent/" + scene.string());
  ASSERT_TRUE(appears(kDiscard)) << "the menu does not ask";
  click(kDiscard);
  EXPECT_TRUE(appears("Cameras/2")) << "the saved bookmark does not come back";
  EXPECT_FALSE(std::filesystem::exists(sidecarPath(other)));
  quit();
}

TEST_F(WindowUnsavedTest, LightsOfABuiltInSceneAreSavedWhereTheUserSays) {
  begin();
  click("Lights/sun");
  key("ctrl+q");
  ASSERT_TRUE(appears("Unsaved changes/file"));
  std::ofstream(folder_.path / "taken") << "a file";
  enter("Unsaved changes/file", (folder_.path / "taken/lamps.irad.json").string());
  EXPECT_TRUE(asks()) << "it is not said that this cannot be written";
  ASSERT_TRUE(window_->running());
  const std::filesystem::path file = folder_.path / "lamps.irad.json";
  enter("Unsaved changes/file", file.string());
  EXPECT_EQ(window_->wait(20), 0);
  ASSERT_TRUE(std::filesystem::exists(file));
  EXPECT_EQ(readSidecar(file).lights->size(), 2u);

  // Dropped, it gives them back; over lights that are unsaved it asks first.
  begin();
  ASSERT_FALSE(has("Lights/1"));
  ASSERT_TRUE(drop({file}));
  EXPECT_TRUE(appears("Lights/1"));
  ASSERT_TRUE(drop({file}));
  EXPECT_TRUE(appears(kCancel)) << "unsaved lights are replaced";
  click(kDiscard);
  EXPECT_TRUE(says("Lights, materials, objects, bookmarks and region are those of lamps.irad.json"));
  quitDiscarding();
}

TEST_F(WindowUnsavedTest, TheSideThatAComparisonLosesIsAskedFor) {
  begin();
  click("Compare/Compare with these settings");
  ASSERT_TRUE(appears("Compare/edit B"));
  choose("Settings/sample.filter", "linear");
  click("Compare/edit A");
  escape();
  ASSERT_TRUE(appears(kCancel)) << "B is lost without being asked for";
  click(kCancel);
  EXPECT_TRUE(has("Compare/End the comparison"));
  click("Compare/End the comparison");
  ASSERT_TRUE(appears("Unsaved changes/presetB"));
  EXPECT_FALSE(has("Unsaved changes/preset")) << "A stays";
  enter("Unsaved changes/presetB", "side B");
  EXPECT_TRUE(appears("Compare/Compare with these settings"));
  EXPECT_TRUE(contains(slurp(preset("side B")), "\"sample.filter\": \"linear\""));
  quit();
}

}  // namespace
}  // namespace irad::test::window_unsaved_suite
