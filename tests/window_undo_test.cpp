// The window keeps what is done in it: undo and redo by keys, menu and list, and what a crash leaves for the next
// start.
#include <fcntl.h>
#include <sys/file.h>
#include <unistd.h>

#include "renderer/scene/sidecar.h"
#include "tests/window_fixture.h"
#include "ui/autosave.h"
#include "ui/presets.h"

namespace irad::test::window_undo_suite {
namespace {

/// Held as another process would.
struct FileLock {
  int file;
  explicit FileLock(const std::filesystem::path& path) : file(open(path.c_str(), O_CREAT | O_RDWR | O_CLOEXEC, 0666)) {
    EXPECT_EQ(flock(file, LOCK_EX), 0);
  }
  ~FileLock() { close(file); }
};

class WindowUndoTest : public WindowTest {
 protected:
  static constexpr const char* kTake = "Unsaved work was found/Take";

  /// A scene of the test's own, whose sidecar may be written.
  std::filesystem::path ownScene() {
    const std::filesystem::path scene = folder_.path / "own.glb";
    std::filesystem::copy_file(assets() / "box.glb", scene);
    return scene;
  }
  void begin(const std::filesystem::path& scene = assets() / "box.glb", std::vector<std::string> more = {}) {
    fold(R"(["Accuracy", "Scene", "Materials", "Objects", "Effects", "Inspector", "Compare", "Solver", "Memory"])");
    start(more, scene);
    away();
    ASSERT_TRUE(viewportSettles(lit));
  }
  /// A window in a process of its own, to be killed.
  void startKilled(const std::filesystem::path& scene = assets() / "box.glb") {
    startsProgram_ = true;
    begin(scene);
    startsProgram_ = false;
  }
  void undo() {
    key("ctrl+z");
    rests();
  }
  void redo() {
    key("ctrl+shift+z");
    rests();
  }
  /// Looks at the list in the menu, which all steps of these tests fit into.
  template <class Look>
  auto inHistory(Look look) {
    choose("Menu/Edit", "History");
    appears(step(0));
    const auto seen = look();
    hold("Escape");
    return seen;
  }
  static std::string step(int number) { return fmt::format("Menu/Edit/History/{}", number); }
  /// The beginning among them.
  int steps() {
    return inHistory([&] {
      int n = 0;
      while (has(step(n))) ++n;
      return n;
    });
  }
  bool shows(const ScreenPart& wanted) {
    away();
    return viewportSettles([&](const ScreenPart& p) { return p == wanted; });
  }
  bool differs(const ScreenPart& from) {
    away();
    return viewportSettles([&](const ScreenPart& p) { return p.difference(from) > 0.01; });
  }
  std::filesystem::path autosaves() const {
    return std::filesystem::path(screen_->environment().at("XDG_CONFIG_HOME")) / "irad/autosave";
  }
  /// The files of autosaves, without their locks.
  std::vector<std::filesystem::path> kept() const {
    std::vector<std::filesystem::path> files;
    std::error_code none;
    for (std::filesystem::directory_iterator it(autosaves(), none), end; !none && it != end; it.increment(none))
      if (it->path().extension() == ".json") files.push_back(it->path());
    return files;
  }
  /// In time there are so many.
  bool keeps(size_t count) {
    for (const auto end = Clock::now() + std::chrono::seconds(20); Clock::now() < end; pause(0.05))
      if (kept().size() == count) return true;
    return false;
  }
};

TEST_F(WindowUndoTest, ADragIsOneStepAndPresetsLightsViewsAndFlightsComeBack) {
  Settings preset = defaultSettings(/*cpuDevice=*/true);
  preset.voxel.resolution = 24;
  preset.matrix.gpu.rays = 16;
  preset.specular.mode = SpecularMode::off;
  Presets(autosaves().parent_path() / "presets", {}).save("mine", preset);
  begin();
  const ScreenPart first = viewport();
  // A view, and two flights, which are one step; the beginning by a click in the menu's list.
  key("3");
  rests();
  for (int i = 0; i < 2; ++i) {
    act("keydown w sleep 0.3 keyup w");
    rests();
  }
  EXPECT_EQ(steps(), 3);
  undo();
  undo();
  EXPECT_TRUE(shows(first)) << "the camera or the view has not come back";
  redo();
  redo();
  EXPECT_TRUE(differs(first));
  inHistory([&] {
    click(step(0));
    return 0;
  });
  EXPECT_TRUE(shows(first)) << "a click goes to no step";

  // A setting, dragged: back with one key, and forth; the menu and its names.
  drag("View/camera.exposure", 40);
  ASSERT_TRUE(differs(first)) << "it is not dragged";
  const ScreenPart exposed = viewport();
  EXPECT_EQ(steps(), 2);
  undo();
  EXPECT_TRUE(shows(first)) << "not undone, or not by one step";
  redo();
  EXPECT_TRUE(shows(exposed)) << "not redone";
  choose("Menu/Edit", "Undo");
  EXPECT_TRUE(shows(first)) << "the menu does not undo";
  key("ctrl+y");
  EXPECT_TRUE(shows(exposed)) << "Ctrl + Y does not redo";
  undo();

  // A preset is one step, whatever it sets; undone it is not unsaved.
  choose("Settings/preset", "mine");
  ASSERT_TRUE(differs(first));
  EXPECT_TRUE(helpOf("Settings/preset").starts_with("Preset: mine")) << helpOf("Settings/preset");
  EXPECT_EQ(steps(), 2) << "the redo that is no more";
  undo();
  EXPECT_TRUE(helpOf("Settings/preset").starts_with("Preset: none")) << helpOf("Settings/preset");
  EXPECT_TRUE(viewportSettles([&](const ScreenPart& p) { return p.difference(first) < 0.01; }));
  EXPECT_TRUE(kept().empty()) << "nothing is unsaved";

  // Lights: added, dragged in the picture, removed; each a step.
  const ScreenPart again = viewport();
  click("Lights/point");
  ASSERT_TRUE(differs(again));
  const ScreenPart added = viewport();
  mouse().dragThrough({at(0, 0), at(-100, -80), at(-200, -160)});
  rests();
  ASSERT_TRUE(differs(added)) << "the light is not dragged";
  EXPECT_EQ(steps(), 3);
  click("Lights/Remove");
  EXPECT_FALSE(has("Lights/1"));
  undo();
  EXPECT_TRUE(isOn("Lights/1")) << "it comes back, and is chosen";
  undo();
  away();  // the button's tooltip reaches over the picture
  EXPECT_TRUE(viewportSettles([&](const ScreenPart& p) { return p.difference(added) < 0.01; })) << "a drag is one step";
  undo();
  EXPECT_FALSE(has("Lights/1"));
  EXPECT_EQ(steps(), 4) << "all can be redone";

  // A name that is typed is one step, and the field's own undo is the field's.
  undo();
  click("Lights/0");
  enter("Lights/0/name", "a long name");
  EXPECT_EQ(steps(), 2);

  // The camera in numbers: as flights that follow each other they are one step. (Where something may be redone they
  // would be none.)
  away();
  const ScreenPart standing = viewport();
  ScreenPart before = standing;
  const auto moves = [&](const char* field, const char* text, double across) {
    enterNumber(field, text, across);
    EXPECT_TRUE(differs(before)) << field;
    before = viewport();
  };
  moves("Cameras/position", "1", 1.0 / 6);  // its x
  moves("Cameras/yaw", "20", 0.5);
  moves("Cameras/view", "70", 0.5);
  EXPECT_EQ(steps(), 3);
  undo();
  EXPECT_TRUE(shows(standing)) << "the camera has not come back";
  undo();

  // The panel's buttons and list.
  click("History/Redo");
  ASSERT_TRUE(appearsUnder("History/Redo", "History/0"));
  EXPECT_FALSE(isOn("History/0"));
  click("History/0");
  EXPECT_TRUE(isOn("History/0"));
  quit();
}

/// In captures, which are drawn from light that is solved anew.
TEST_F(WindowUndoTest, UndoAndRedoGiveTheSameBits) {
  begin();
  int captures = 0;
  const auto picture = [&] {
    ++captures;
    key("F12");
    EXPECT_TRUE(says(fmt::format("box.{:03}", captures)));
    return contents(folder_.path / fmt::format("out/captures/box.{:03}", captures)).at("lit.exr");
  };
  const std::string first = picture();
  enterNumber("Settings/matrix.rays", "48");
  away();
  const std::string edited = picture();
  EXPECT_NE(edited, first);
  undo();
  EXPECT_EQ(picture(), first);
  redo();
  EXPECT_EQ(picture(), edited);
  undo();
  quit();
}

TEST_F(WindowUndoTest, ACancelledRebuildReturnsTheSettingThatWasBuilt) {
  begin();
  const ScreenPart first = part();  // above the messages
  cancel([&] {
    // As enterNumber(), which would wait until the rebuild is done.
    act("keydown ctrl");
    mouse().tap(placeOf("Settings/matrix.rays"));
    rests();
    act("keyup ctrl");
    hold("ctrl", "a");
    type("4096");
    act("keydown Return");
    EXPECT_TRUE(appears("progress/cancel"));
    act("keyup Return");
  });
  EXPECT_TRUE(says("the settings are those of the picture again"));
  rests();
  EXPECT_EQ(part(), first);
  EXPECT_TRUE(inHistory([&] { return isOn(step(0)); }));
  EXPECT_EQ(steps(), 2) << "it may be redone";
  // Ctrl + Z in the middle of a rebuild gives it up, too.
  key("ctrl+shift+z");
  ASSERT_TRUE(appears("progress/cancel"));
  key("ctrl+z");
  ASSERT_TRUE(appears("progress/cancel", false, 10)) << "the rebuild goes on";
  away();
  EXPECT_TRUE(settles([this] { return part(); }, [&](const ScreenPart& p) { return p == first; }));
  quit();  // nothing is unsaved
}

TEST_F(WindowUndoTest, AKilledWindowsWorkIsOfferedAndTaken) {
  const std::filesystem::path scene = ownScene();
  startKilled(scene);
  EXPECT_TRUE(kept().empty());
  click("Lights/point");
  ASSERT_TRUE(keeps(1)) << "no autosave";
  click("Cameras/Add bookmark");
  choose("Settings/sample.filter", "linear");
  key("3");
  // The last edit is in the file by the time that the window sleeps.
  const auto whole = [&] {
    const Autosave autosave = readAutosave(kept().at(0));
    return autosave.edits.bookmarks.size() == 1 && autosave.settings.sample.gpu.filter_ == SampleFilter::linear;
  };
  rests();
  const Autosave kill = readAutosave(kept().at(0));
  EXPECT_TRUE(whole());
  EXPECT_EQ(kill.scene, scene);
  EXPECT_EQ(kill.edits.lights->size(), 2u);
  window_->killNow();
  ASSERT_EQ(kept().size(), 1u);

  // The next start, of another scene, asks; Esc leaves it for the one after.
  begin();
  ASSERT_TRUE(appears(kTake)) << "nothing is offered";
  hold("Escape");
  EXPECT_TRUE(appears(kTake, false)) << "Esc does not close it";
  EXPECT_FALSE(has("Lights/1"));
  quit();
  EXPECT_EQ(kept().size(), 1u);
  EXPECT_FALSE(std::filesystem::exists(sidecarPath(scene))) << "saved without being asked";

  // Taken: its scene is opened with all of it, as one step, still unsaved and still kept.
  startKilled();
  click(kTake);
  EXPECT_TRUE(appears("Lights/1")) << "no light";
  shown("Cameras/Add bookmark");  // below the list, whose rows are there once it is in view
  EXPECT_TRUE(appears("Cameras/2")) << "no bookmark";
  EXPECT_TRUE(keeps(1));
  EXPECT_EQ(readAutosave(kept().at(0)).edits, kill.edits);
  EXPECT_EQ(readAutosave(kept().at(0)).settings, kill.settings);
  EXPECT_EQ(steps(), 2);
  {
    // A disk that takes its time holds nothing up: as long as another has the temporary file, nothing is written.
    const std::filesystem::path file = kept().at(0).filename();
    const auto process = file.stem().stem().string();
    const FileLock disk(autosaves() / fmt::format(".{}.{}.irad-tmp", file.string(), process));
    mouse().tap(placeOf("Cameras/Add bookmark"));
    EXPECT_TRUE(appears("Cameras/3", true, 10)) << "the window waits for the disk";
    EXPECT_EQ(readAutosave(kept().at(0)).edits.bookmarks.size(), 1u);
  }
  rests();
  EXPECT_EQ(readAutosave(kept().at(0)).edits.bookmarks.size(), 2u) << "what waited is not kept";
  undo();
  undo();
  EXPECT_FALSE(has("Lights/1"));
  redo();
  // Killed again it is offered again, with that, too.
  EXPECT_EQ(readAutosave(kept().at(0)).edits, kill.edits);
  window_->killNow();
  begin();
  click(kTake);
  ASSERT_TRUE(appears("Lights/1"));
  click("Lights/Save");
  ASSERT_TRUE(says("Saved lights, materials, objects, bookmarks and region to " + sidecarPath(scene).string()));
  EXPECT_EQ(readSidecar(sidecarPath(scene)).lights, kill.edits.lights);
  quitDiscarding();  // the settings
  EXPECT_TRUE(std::filesystem::is_empty(autosaves())) << "something is kept of a window that has ended";

  // Reverted twice: the lights of the scene's own file.
  begin(scene);
  ASSERT_FALSE(has(kTake));
  ASSERT_TRUE(has("Lights/1"));
  click("Lights/point");
  click("Lights/Revert");
  EXPECT_TRUE(has("Lights/1"));
  EXPECT_FALSE(has("Lights/2"));
  click("Lights/Revert");
  EXPECT_FALSE(has("Lights/1"));
  EXPECT_TRUE(has("Lights/0"));
  quitDiscarding();
}

TEST_F(WindowUndoTest, BothSidesOfAComparisonAreTakenAndTheNextTimeDiscarded) {
  startKilled();
  click("Compare");
  click("Compare/Compare with these settings");
  ASSERT_TRUE(appears("Compare/edit B"));
  choose("Settings/sample.filter", "linear");
  ASSERT_TRUE(keeps(1));
  window_->killNow();
  const auto filters = [&] {
    const Autosave a = readAutosave(kept().at(0));
    return std::pair(a.settings.sample.gpu.filter_, a.other ? a.other->sample.gpu.filter_ : SampleFilter::nearest);
  };
  const auto before = filters();
  EXPECT_EQ(before.second, SampleFilter::linear);
  EXPECT_NE(before.first, before.second);
  startKilled();
  click(kTake);
  click("Compare");
  EXPECT_TRUE(appears("Compare/End the comparison")) << "no comparison";
  ASSERT_TRUE(keeps(1));
  EXPECT_EQ(filters(), before);
  window_->killNow();
  begin();
  ASSERT_TRUE(appears(kTake));
  click("Unsaved work was found/Discard");
  EXPECT_TRUE(keeps(0));
  EXPECT_FALSE(has(kTake));
  quit();
  begin();
  EXPECT_FALSE(has(kTake));
  quit();
}

/// Every list, popup and field of every panel: Esc closes it, and the window stays.
TEST_F(WindowUndoTest, EscClosesInEveryPanelAndNeverQuits) {
  fold("[]");
  start();
  away();
  ASSERT_TRUE(viewportSettles(lit));
  click("Lights/0");
  click("Cameras/Add bookmark");
  const auto closes = [&](const std::string& control, const std::string& opened) {
    click(control);
    EXPECT_TRUE(opened.empty() || appears(opened)) << control;
    hold("Escape");
    hold("Escape");
    EXPECT_TRUE(opened.empty() || !has(opened)) << control << " stays open";
    ASSERT_TRUE(window_->running()) << control;
  };
  // Esc lets go of the light, too.
  const auto chooseLight = [&] {
    shown("Lights/point");
    if (!isOn("Lights/0")) click("Lights/0");
  };
  for (const char* menu : {"File", "Edit", "View", "Solver", "Help"}) {
    click(std::string("Menu/") + menu);
    hold("Escape");
    EXPECT_TRUE(has(std::string("Menu/") + menu)) << menu << " stays open";
  }
  if (!has("Scene/open")) click("Scene");
  closes("Scene/open", "");
  chooseLight();
  closes("Lights/0/type", "Lights/0/type/sun");
  chooseLight();
  closes("Lights/0/name", "");
  closes("Cameras/name", "");
  closes("Materials/search", "");
  closes("Objects/search", "");
  closes("Accuracy/samples", "Accuracy/samples/64");
  closes("Timings/window", "Timings/window/600 frames");
  closes("Settings/preset", "Settings/preset/fast");
  closes("Effects/emission", "Effects/emission/off");
  closes("View/view", "View/view/lit");
  press(at(0, 100));
  ASSERT_TRUE(appears("Inspector/Clear"));
  closes("Inspector/filter", "");
  for (int i = 0; i < 4; ++i) hold("Escape");
  ASSERT_TRUE(window_->running());
  quitDiscarding();  // the bookmark
}

}  // namespace
}  // namespace irad::test::window_undo_suite
