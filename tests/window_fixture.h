// The window as a user has it: `irad view` under a virtual X server of the test's own, driven by synthetic keys and
// mouse, watched through the server's framebuffer. Skipped, in words, where Xvfb is not installed.
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <fstream>
#include <functional>

#include "tests/controls.h"
#include "tests/file_drop.h"
#include "tests/mouse.h"
#include "tests/window_host.h"

namespace irad::test {

class WindowTest : public ::testing::Test {
 protected:
  static constexpr const char* kWidePanels = R"("left": 370, "right": 320, "bottom": 288, )";
  bool exposesFiles_ = false;  ///< as the window does where no exposure is given
  /// Three quarters of the pixels, of window and picture; of panels more has to be scrolled.
  static constexpr const char* kLow = "1280x560";
  std::string windowSize_ = "1280x720";
  std::string detail_ = "16";  ///< voxels along the Box, and rays of a facet
  /// Panels at the sizes of a first start. Otherwise fold() makes them wide: most of what a window takes on a CPU
  /// rasterizer goes by the picture's pixels.
  bool firstSizes_ = false;
  /// Where the process is what is tested. Other windows come one after another in the same one, whose device they find
  /// with the pipelines that those before have made.
  bool startsProgram_ = false;

  void SetUp() override {
    if (!installed("Xvfb")) GTEST_SKIP() << "Xvfb is not installed: the window is not tested";
    screen_ = std::make_unique<VirtualScreen>(1600, 1000);
  }
  void TearDown() override {
    if (HasFailure() && window_) std::cerr << "irad said:\n" << window_->log();
  }

  /// A small Box, so that one picture takes a fraction of a second on a CPU rasterizer, whose light is solved with one
  /// frame: pictures of light on its way take most of what such a device has to do, and no test here looks at them.
  void start(std::vector<std::string> more = {}, const std::filesystem::path& scene = assets() / "box.glb") {
    std::vector<std::string> command{iradProgram(),  "view",
                                     scene.string(), "--size",
                                     windowSize_,    "--validate",
                                     "--set",        "voxel.resolution=" + detail_,
                                     "--set",        "matrix.rays=" + detail_,
                                     "--set",        "solver.sweeps_per_frame=100",
                                     "--set",        "specular.mode=off",
                                     "--set",        "light.shadow_resolution=256",
                                     "--controls",   controlsFile().string()};
    if (!exposesFiles_) command.insert(command.end(), {"--set", "camera.exposure=0"});
    command.insert(command.end(), more.begin(), more.end());
    std::map<std::string, std::string> environment = screen_->environment();
    environment.insert(environment_.begin(), environment_.end());
    // Where it covers nothing that is compared: the server draws its pointer, too.
    act("mousemove 700 6");
    window_.reset();
    if (startsProgram_)
      window_ = std::make_unique<Program>(command, folder_.path, environment);
    else
      window_ = std::make_unique<HostedWindow>(command, folder_.path, environment);
  }
  /// Remembered from an earlier run, as a JSON array of titles: the other panels are where a test looks for them.
  void fold(const char* panels) {
    const std::filesystem::path folder = std::filesystem::path(screen_->environment().at("XDG_CONFIG_HOME")) / "irad";
    std::filesystem::create_directories(folder);
    // The picture keeps its shape.
    std::ofstream(folder / "window.json")
        << fmt::format(R"({{"format": 1, {}"folded": {}}})", firstSizes_ ? "" : kWidePanels, panels);
  }
  /// For tests of the picture, of menus and of messages: no panel is open but the strip's.
  void foldPanels() {
    fold(R"(["Accuracy", "Scene", "Lights", "Effects", "Materials", "Objects", "Cameras", "View", "Compare", "Solver",
             "Memory", "Settings", "Inspector", "History"])");
  }
  void act(const std::string& commands) { screen_->act(commands); }
  void key(const std::string& name) { screen_->key(name); }

  // ---- Controls by name (ui/controls.h) ----

  std::filesystem::path controlsFile() const { return folder_.path / "controls"; }
  std::vector<Control> controls() const { return readControls(controlsFile()); }
  bool has(const std::string& name) const {
    const std::vector<Control> all = controls();
    return std::any_of(all.begin(), all.end(), [&](const Control& c) { return c.name == name; });
  }
  /// Waits until there is such a control, or none.
  bool appears(const std::string& name, bool wanted = true, double seconds = 60) {
    for (const auto end = Clock::now() + std::chrono::duration<double>(seconds); Clock::now() < end; pause(0.02))
      if (has(name) == wanted) return true;
    return false;
  }
  bool isOn(const std::string& name) { return control(name).on; }
  /// What is said while the mouse rests on it.
  std::string helpOf(const std::string& name) {
    control(name);
    std::istringstream lines(slurp(controlsFile().string() + ".help"));
    for (std::string line; std::getline(lines, line);)
      if (line.starts_with(name + '\t')) return line.substr(name.size() + 1);
    return {};
  }
  /// The control, once it is drawn; throws with near names where it is not drawn in time.
  Control control(const std::string& name) {
    appears(name);
    return findControl(controls(), name);
  }
  /// The control with its middle in view: turns the wheel over its region until it is.
  Control shown(const std::string& name) {
    constexpr int kMostPerTurn = 120;  // pixels that a turn scrolls by, at most
    Control c = control(name);
    for (int turn = 0; turn < 60; ++turn) {
      const int middle = c.area.y + c.area.height / 2;
      const bool below = middle >= c.region.bottom();
      if (middle >= c.region.y && !below) return c;
      const int turns = 1 + (below ? middle - c.region.bottom() : c.region.y - middle) / kMostPerTurn;
      // At its edge: in its middle a list within it may take the wheel.
      act(fmt::format("mousemove {} {} click --repeat {} --delay 1 {}", c.region.x + 3,
                      c.region.y + c.region.height / 2, turns, below ? 5 : 4));
      rests();
      c = control(name);
    }
    throw std::runtime_error(fmt::format("'{}' cannot be scrolled into view", name));
  }
  /// Turns the wheel below a control until one under it is there: rows of lists that are out of view are not drawn.
  bool appearsUnder(const std::string& above, const std::string& name) {
    for (int turn = 0; turn < 20 && !has(name); ++turn) {
      const Control::Area region = control(above).region;
      act(fmt::format("mousemove {} {} click 5", region.x + 3, region.y + region.height / 2));
      rests();
    }
    return has(name);
  }
  /// Where its middle is, or another share of it.
  std::string placeOf(const std::string& name, double across = 0.5) {
    const Control c = shown(name);
    if (c.disabled) throw std::runtime_error(fmt::format("'{}' is disabled", name));
    return fmt::format("{} {}", c.area.x + static_cast<int>(across * c.area.width), c.area.y + c.area.height / 2);
  }
  Mouse mouse() const { return {*screen_, controlsFile()}; }
  void press(const std::string& place) {
    mouse().tap(place);
    rests();
  }
  void click(const std::string& name) { press(placeOf(name)); }
  /// Frames of so many seconds, by the panel Timings; while they are recorded the window does not rest.
  void record(double seconds) {
    const std::string button = placeOf("Timings/record");
    mouse().tap(button);
    pause(seconds);
    mouse().tap(button);
  }
  /// An entry of a list, or of a menu.
  void choose(const std::string& list, const std::string& entry) {
    click(list);
    click(list + "/" + entry);
  }
  /// From its middle, by so many pixels.
  void drag(const std::string& name, int right, int down = 0, double across = 0.5) {
    const std::string from = placeOf(name, across);
    const size_t space = from.find(' ');
    mouse().dragThrough(
        {from, fmt::format("{} {}", std::stoi(from.substr(0, space)) + right, std::stoi(from.substr(space)) + down)});
    rests();
  }
  /// Turns the wheel there with Ctrl, which is held until that has been seen.
  void zoomAt(const std::string& place, int turns) {
    mouse().moveTo(place);
    act(fmt::format("keydown ctrl click --repeat {} --delay 1 4", turns));
    rests();
    act("keyup ctrl");
    rests();
  }
  /// Presses a key long enough for ImGui, which looks at keys once per frame, to see it.
  void hold(const std::string& key, const std::string& with = "") {
    const std::string second = with.empty() ? "" : " keydown " + with, up = with.empty() ? "" : " keyup " + with;
    act("keydown " + key + second);
    rests();
    act("keyup " + key + up);
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
    const std::string place = placeOf(name, across);
    mouse().moveTo(place);
    // Ctrl is held until the click has been seen: a frame may take seconds, and sees the keys as they are at its start.
    act("keydown ctrl");
    rests();
    press(place);
    act("keyup ctrl");
    rests();
    hold("ctrl", "a");
    type(text);
    hold("Return");
  }
  void type(const std::string& text) {
    if (!text.empty()) screen_->input().type(text);
    rests();
  }
  /// Where the picture is; the program says it, so that no test knows the layout.
  Control::Area picture() {
    appears("viewport", true, 120);  // from the first frame on
    return control("viewport").area;
  }
  /// A place in the picture, from its middle to the right and down, in thousandths of its height: what is seen there
  /// does not depend on the picture's size.
  std::string at(int right, int down) {
    const Control::Area p = picture();
    return fmt::format("{} {}", p.x + p.width / 2 + right * p.height / 1000,
                       p.y + p.height / 2 + down * p.height / 1000);
  }
  /// A part of it, given likewise.
  ScreenPart around(int right, int down, int width, int height) {
    const Control::Area p = picture();
    return screen_->grab(p.x + p.width / 2 + right * p.height / 1000, p.y + p.height / 2 + down * p.height / 1000,
                         width * p.height / 1000, height * p.height / 1000);
  }
  /// In the picture, but not in the part of it that is compared.
  std::string aside() {
    const Control::Area p = picture();
    return fmt::format("{} {}", p.x + 28, p.bottom() - 22);
  }
  /// Moves the mouse there.
  void goAside() { act("mousemove " + aside()); }
  void away() {
    goAside();
    rests();
  }

  /// Waits until the window has nothing more to do, nor the server for it. The first window of a machine compiles every
  /// pipeline, which takes minutes beside other tests; what has no rest after that ends the test, for no picture of it
  /// can be compared.
  void rests() {
    const auto asleep = [this] { return std::pair(screen_->server().asleep(), window_->asleep()); };
    for (const auto end = Clock::now() + kPatience; Clock::now() < end && window_->running();) {
      const auto before = asleep();
      pause(0.05);
      if (before.first && before.second && asleep() == before) return;
    }
    if (window_->running()) throw std::runtime_error("the window does not come to rest");
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

  /// The middle of the picture, of which the status line and one message take the lowest 75 rows. The mouse stays in
  /// the picture but out of this part: the server draws its pointer into the framebuffer.
  ScreenPart viewport() {
    const Control::Area p = picture();
    return screen_->grab(p.x + 68, p.y + 70, p.width - 167, p.height - 148);
  }
  /// The part of it above the messages.
  ScreenPart part() {
    const Control::Area p = picture();
    return screen_->grab(p.x + 68, p.y + 30, p.width - 167, (p.height - 63) / 2);
  }

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
    // Before a rebuild by F5 all shaders are compiled, which takes a busy machine more than 20 seconds.
    ASSERT_TRUE(appears("progress/cancel", true, 90)) << "no progress is shown";
    for (const Control& c : controls())
      if (c.name == "progress/cancel")
        mouse().tap(fmt::format("{} {}", c.area.x + c.area.width / 2, c.area.y + c.area.height / 2));
    for (int i = 0; i < 400 && times() == before; ++i) pause(0.05);
    EXPECT_EQ(times(), before + 1) << "the button does not cancel";
    goAside();
  }
  /// A folder for --shaders with these sources and every header. F5 compiles what it finds there: all sources take it
  /// four processor seconds (they are compiled in tests/shader_test.cpp).
  std::filesystem::path copyShaders(const std::vector<std::string>& sources) const {
    const std::filesystem::path from = sourceFolder() / "shaders", copy = folder_.path / "shaders";
    for (const auto& entry : std::filesystem::recursive_directory_iterator(from)) {
      const std::string name = entry.path().lexically_relative(from).string(), extension = entry.path().extension();
      if (extension != ".h" && extension != ".glsl" && std::ranges::find(sources, name) == sources.end()) continue;
      std::filesystem::create_directories((copy / name).parent_path());
      std::filesystem::copy_file(entry.path(), copy / name);
    }
    for (const std::string& source : sources) EXPECT_TRUE(std::filesystem::exists(copy / source)) << source;
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
  std::unique_ptr<Running> window_;
};

const auto lit = [](const ScreenPart& p) { return p.meanLuminance() > 0.05 && p.deviation() > 0.02; };

}  // namespace irad::test
