// The window as a user has it: `irad view` under a virtual X server of the test's own, driven by synthetic keys and
// mouse, watched through the server's framebuffer. Skipped, in words, where Xvfb or xdotool is not installed.
#pragma once

#include <gtest/gtest.h>

#include <fstream>
#include <functional>

#include "tests/file_drop.h"
#include "tests/virtual_screen.h"

namespace irad::test {

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
  std::map<std::string, std::string> environment_;  ///< of windows that start(), beside the screen's
  std::unique_ptr<Program> window_;
};

const auto lit = [](const ScreenPart& p) { return p.meanLuminance() > 0.05 && p.deviation() > 0.02; };

}  // namespace irad::test
