// The window as a user has it: `irad view` under a virtual X server of the test's own, driven by synthetic keys and
// mouse, watched through the server's framebuffer. Skipped, in words, where Xvfb or xdotool is not installed.
#pragma once

#include <gtest/gtest.h>

#include <fstream>
#include <functional>

#include "tests/controls.h"
#include "tests/file_drop.h"
#include "tests/virtual_screen.h"

namespace irad::test {

class WindowTest : public ::testing::Test {
 protected:
  bool exposesFiles_ = false;  ///< as the window does where no exposure is given

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
    std::vector<std::string> command{iradProgram(),  "view",
                                     scene.string(), "--size",
                                     "1280x720",     "--validate",
                                     "--set",        "voxel.resolution=32",
                                     "--set",        "matrix.rays=32",
                                     "--set",        "specular.mode=off",
                                     "--controls",   controlsFile().string()};
    if (!exposesFiles_) command.insert(command.end(), {"--set", "camera.exposure=0"});
    command.insert(command.end(), more.begin(), more.end());
    std::map<std::string, std::string> environment = screen_->environment();
    environment.insert(environment_.begin(), environment_.end());
    window_ = std::make_unique<Program>(command, folder_.path, environment);
  }
  /// Remembered from an earlier run, as a JSON array of titles: the other panels are where a test looks for them.
  void fold(const char* panels) {
    const std::filesystem::path folder = std::filesystem::path(screen_->environment().at("XDG_CONFIG_HOME")) / "irad";
    std::filesystem::create_directories(folder);
    std::ofstream(folder / "window.json") << fmt::format(R"({{"format": 1, "folded": {}}})", panels);
  }
  void xdotool(const std::string& arguments) { screen_->xdotool(arguments); }
  void key(const std::string& name) { screen_->key(name); }

  // ---- Controls by name (ui/controls.h) ----

  std::filesystem::path controlsFile() const { return folder_.path / "controls"; }
  std::vector<Control> controls() const { return readControls(controlsFile()); }
  bool has(const std::string& name) const {
    const std::vector<Control> all = controls();
    return std::any_of(all.begin(), all.end(), [&](const Control& c) { return c.name == name; });
  }
  /// Waits until there is such a control, or none.
  bool appears(const std::string& name, bool wanted = true, double seconds = 20) {
    for (const auto end = Clock::now() + std::chrono::duration<double>(seconds); Clock::now() < end; pause(0.02))
      if (has(name) == wanted) return true;
    return false;
  }
  bool isOn(const std::string& name) { return control(name).on; }
  /// The control, once it is drawn; throws with near names where it is not drawn in time.
  Control control(const std::string& name) {
    appears(name);
    return findControl(controls(), name);
  }
  /// The control with its middle in view: turns the wheel over its region until it is.
  Control shown(const std::string& name) {
    Control c = control(name);
    for (int turn = 0; turn < 60; ++turn) {
      const int middle = c.area.y + c.area.height / 2;
      const bool below = middle >= c.region.bottom();
      if (middle >= c.region.y && !below) return c;
      xdotool(fmt::format("mousemove {} {} click {}", c.region.x + c.region.width / 2, c.region.y + c.region.height / 2,
                          below ? 5 : 4));
      rests();
      c = control(name);
    }
    throw std::runtime_error(fmt::format("'{}' cannot be scrolled into view", name));
  }
  /// Where its middle is, or another share of it.
  std::string placeOf(const std::string& name, double across = 0.5) {
    const Control c = shown(name);
    if (c.disabled) throw std::runtime_error(fmt::format("'{}' is disabled", name));
    return fmt::format("{} {}", c.area.x + static_cast<int>(across * c.area.width), c.area.y + c.area.height / 2);
  }
  void press(const std::string& place) {
    xdotool(fmt::format("mousemove {} sleep 0.05 mousedown 1 sleep 0.05 mouseup 1", place));
    rests();
  }
  void click(const std::string& name) { press(placeOf(name)); }
  /// An entry of a list, or of a menu.
  void choose(const std::string& list, const std::string& entry) {
    click(list);
    click(list + "/" + entry);
  }
  /// From its middle, by so many pixels.
  void drag(const std::string& name, int right, int down = 0, double across = 0.5) {
    xdotool(fmt::format("mousemove {} sleep 0.05 mousedown 1 sleep 0.1 mousemove_relative -- {} {} sleep 0.1 mouseup 1",
                        placeOf(name, across), right, down));
    rests();
  }
  /// Presses a key long enough for ImGui, which looks at keys once per frame, to see it.
  void hold(const std::string& key, const std::string& with = "") {
    const std::string second = with.empty() ? "" : " keydown " + with, up = with.empty() ? "" : " keyup " + with;
    xdotool("keydown " + key + second);
    rests();
    xdotool("keyup " + key + up);
    rests();
  }
  /// In place of what the field holds; Return leaves it.
  void enter(const std::string& name, const std::string& text) {
    click(name);
    hold("ctrl", "a");
    hold("BackSpace");
    type(text);
    hold("Return");
  }
  /// The same into a slider or a field that is dragged: a click with Ctrl makes it a text field.
  void enterNumber(const std::string& name, const std::string& text, double across = 0.5) {
    xdotool("mousemove " + placeOf(name, across));
    rests();
    xdotool("keydown ctrl sleep 0.2 mousedown 1 sleep 0.2 mouseup 1 keyup ctrl");
    rests();
    hold("ctrl", "a");
    type(text);
    hold("Return");
  }
  void type(const std::string& text) {
    if (!text.empty()) xdotool("type --delay 15 '" + text + "'");
    rests();
  }
  /// Moves the mouse over the picture, but not over the part of it that is compared.
  void away() {
    xdotool("mousemove 360 510");
    rests();
  }

  /// Waits until the window has nothing more to do, nor the server for it.
  void rests() {
    const auto asleep = [this] { return std::pair(screen_->server().asleep(), window_->asleep()); };
    for (const auto end = Clock::now() + std::chrono::seconds(60); Clock::now() < end && window_->running();) {
      const auto before = asleep();
      pause(0.05);
      if (before.first && before.second && asleep() == before) return;
    }
    EXPECT_FALSE(window_->running()) << "the window does not come to rest";
  }

  /// With Ctrl + Q; nothing is unsaved, validation is on.
  void quit() {
    key("ctrl+q");
    EXPECT_EQ(window_->wait(20), 0) << (has("Unsaved changes/Discard") ? "it asks: something is unsaved" : "");
  }
  /// The same, and what is unsaved is asked for and discarded.
  void quitDiscarding() {
    key("ctrl+q");
    EXPECT_TRUE(appears("Unsaved changes/Discard")) << "it does not ask";
    click("Unsaved changes/Discard");
    EXPECT_EQ(window_->wait(20), 0);
  }

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
    const size_t before = times();
    startWork();
    ASSERT_TRUE(appears("progress/cancel")) << "no progress is shown";
    // A busy device draws seldom, and the window may miss a click.
    for (int tries = 0; tries < 10 && times() == before; ++tries) {
      for (const Control& c : controls())
        if (c.name == "progress/cancel")
          xdotool(fmt::format("mousemove {} {} sleep 0.3 mousedown 1 sleep 0.3 mouseup 1", c.area.x + c.area.width / 2,
                              c.area.y + c.area.height / 2));
      for (int i = 0; i < 40 && times() == before; ++i) pause(0.05);
    }
    EXPECT_EQ(times(), before + 1) << "the button does not cancel";
    xdotool("mousemove 360 510");
  }
  std::filesystem::path copyShaders() const {
    const std::filesystem::path copy = folder_.path / "shaders";
    std::filesystem::copy(sourceFolder() / "shaders", copy, std::filesystem::copy_options::recursive);
    return copy;
  }

  /// Waits until program and server sleep (nothing more will change) and `region` satisfies `wanted`; false after
  /// `seconds`.
  bool settles(const std::function<ScreenPart()>& region, const std::function<bool(const ScreenPart&)>& wanted,
               double seconds = 120) {
    for (const auto end = Clock::now() + std::chrono::duration<double>(seconds); Clock::now() < end;) {
      if (!window_->running()) return false;
      rests();
      if (wanted(region())) return true;
      pause(0.1);
    }
    return false;
  }
  bool viewportSettles(const std::function<bool(const ScreenPart&)>& wanted) {
    return settles([this] { return viewport(); }, wanted);
  }

  TemporaryFolder folder_;
  std::unique_ptr<VirtualScreen> screen_;
  std::map<std::string, std::string> environment_;  ///< of windows that start(), beside the screen's
  std::unique_ptr<Program> window_;
};

const auto lit = [](const ScreenPart& p) { return p.meanLuminance() > 0.05 && p.deviation() > 0.02; };

}  // namespace irad::test
