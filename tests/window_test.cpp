// The window as a user has it: `irad view` under a virtual X server of the test's own, driven by synthetic keys and
// mouse, watched through the server's framebuffer. Skipped, in words, where Xvfb or xdotool is not installed.
#include <fcntl.h>
#include <fmt/format.h>
#include <gtest/gtest.h>
#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <cmath>
#include <cstdlib>
#include <cstring>
#include <fstream>
#include <functional>
#include <map>
#include <sstream>
#include <thread>

#include "tests/support.h"

namespace irad {
namespace {

using Clock = std::chrono::steady_clock;

void pause(double seconds) {
  std::this_thread::sleep_for(std::chrono::duration<double>(seconds));
}

std::string readText(const std::filesystem::path& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

/// A child process with its standard error in a file.
class Process {
 public:
  Process(const std::vector<std::string>& command, const std::filesystem::path& folder,
          const std::map<std::string, std::string>& environment, int inheritedFd = -1)
      : log_(folder / (std::filesystem::path(command[0]).filename().string() + ".log")) {
    pid_ = fork();
    if (pid_ != 0) return;
    for (const auto& [name, value] : environment) setenv(name.c_str(), value.c_str(), 1);
    const int log = open(log_.c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0644);
    dup2(log, STDOUT_FILENO);
    dup2(log, STDERR_FILENO);
    if (chdir(folder.c_str()) != 0) _exit(126);
    (void)inheritedFd;  // stays open across exec
    std::vector<char*> arguments;
    for (const std::string& a : command) arguments.push_back(const_cast<char*>(a.c_str()));
    arguments.push_back(nullptr);
    execvp(arguments[0], arguments.data());
    _exit(127);
  }
  ~Process() {
    if (running()) {
      kill(pid_, SIGKILL);
      waitpid(pid_, nullptr, 0);
    }
  }
  Process(const Process&) = delete;

  bool running() {
    if (!status_ && waitpid(pid_, &raw_, WNOHANG) == pid_)
      status_ = WIFEXITED(raw_) ? WEXITSTATUS(raw_) : 128 + WTERMSIG(raw_);
    return !status_;
  }
  /// Exit status, or -1 when it still runs after `seconds`.
  int wait(double seconds) {
    for (const auto end = Clock::now() + std::chrono::duration<double>(seconds); running();) {
      if (Clock::now() > end) return -1;
      pause(0.02);
    }
    return *status_;
  }
  /// Processor time used so far by all its threads, seconds.
  double cpuSeconds() const {
    const std::string stat = readText(fmt::format("/proc/{}/stat", pid_));
    std::istringstream fields(stat.substr(stat.rfind(')') + 2));
    std::string skipped;
    for (int i = 3; i < 14; ++i) fields >> skipped;
    double user = 0, system = 0;
    fields >> user >> system;
    return (user + system) / static_cast<double>(sysconf(_SC_CLK_TCK));
  }
  std::string log() const { return readText(log_); }

 private:
  std::filesystem::path log_;
  pid_t pid_ = -1;
  int raw_ = 0;
  std::optional<int> status_;
};

bool installed(const std::string& program) {
  return std::system(fmt::format("command -v {} >/dev/null 2>&1", program).c_str()) == 0;
}

/// A part of the screen, RGB.
struct Picture {
  int width = 0, height = 0;
  std::vector<uint8_t> rgb;
  bool operator==(const Picture&) const = default;

  double meanLuminance() const {
    double sum = 0;
    for (size_t i = 0; i + 2 < rgb.size(); i += 3) sum += 0.2126 * rgb[i] + 0.7152 * rgb[i + 1] + 0.0722 * rgb[i + 2];
    return sum / (255.0 * static_cast<double>(rgb.size() / 3));
  }
  double deviation() const {
    const double mean = meanLuminance();
    double sum = 0;
    for (size_t i = 0; i + 2 < rgb.size(); i += 3)
      sum += std::pow((0.2126 * rgb[i] + 0.7152 * rgb[i + 1] + 0.0722 * rgb[i + 2]) / 255.0 - mean, 2);
    return std::sqrt(sum / static_cast<double>(rgb.size() / 3));
  }
  /// Share of pixels that differ.
  double difference(const Picture& other) const {
    if (rgb.size() != other.rgb.size()) return 1;
    size_t differing = 0;
    for (size_t i = 0; i + 2 < rgb.size(); i += 3)
      differing += rgb[i] != other.rgb[i] || rgb[i + 1] != other.rgb[i + 1] || rgb[i + 2] != other.rgb[i + 2];
    return static_cast<double>(differing) / static_cast<double>(rgb.size() / 3);
  }
};

/// Xvfb on a free display, its framebuffer readable as a file.
class VirtualScreen {
 public:
  VirtualScreen(int width, int height) {
    int fds[2] = {};
    if (pipe(fds) != 0) throw std::runtime_error("pipe");
    server_ = std::make_unique<Process>(std::vector<std::string>{"Xvfb", "-displayfd", std::to_string(fds[1]),
                                                                 "-screen", "0", fmt::format("{}x{}x24", width, height),
                                                                 "-fbdir", folder_.path.string(), "-nolisten", "tcp"},
                                        folder_.path, std::map<std::string, std::string>{}, fds[1]);
    close(fds[1]);
    char number[16] = {};
    const ssize_t got = read(fds[0], number, sizeof(number) - 1);
    close(fds[0]);
    if (got <= 0) throw std::runtime_error("Xvfb did not start: " + server_->log());
    display_ = fmt::format(":{}", std::string_view(number, strcspn(number, "\n")));
  }
  std::map<std::string, std::string> environment() const {
    return {{"DISPLAY", display_}, {"XDG_SESSION_TYPE", "x11"}};
  }

  /// The framebuffer is in the XWD format: big-endian header, then rows of BGRX.
  Picture grab(int x, int y, int width, int height) const {
    const std::string file = readText(folder_.path / "Xvfb_screen0");
    const auto word = [&](size_t i) {
      uint32_t value = 0;
      for (size_t b = 0; b < 4; ++b) value = value << 8 | static_cast<uint8_t>(file.at(4 * i + b));
      return value;
    };
    const size_t pixels = word(0) + 12 * size_t{word(19)}, row = word(12), depth = word(11) / 8;
    Picture picture{width, height, {}};
    for (int j = y; j < y + height; ++j)
      for (int i = x; i < x + width; ++i)
        for (int c = 2; c >= 0; --c)
          picture.rgb.push_back(static_cast<uint8_t>(file.at(pixels + row * static_cast<size_t>(j) +
                                                             depth * static_cast<size_t>(i) + static_cast<size_t>(c))));
    return picture;
  }

 private:
  test::TemporaryFolder folder_;
  std::unique_ptr<Process> server_;
  std::string display_;
};

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
  void start(std::vector<std::string> more = {}) {
    std::vector<std::string> command{IRAD_BINARY,
                                     "view",
                                     (test::assets() / "box.glb").string(),
                                     "--size",
                                     "1280x720",
                                     "--validate",
                                     "--set",
                                     "voxel.resolution=32",
                                     "--set",
                                     "matrix.rays=32",
                                     "--set",
                                     "specular.mode=off"};
    command.insert(command.end(), more.begin(), more.end());
    window_ = std::make_unique<Process>(command, folder_.path, screen_->environment());
  }
  void xdotool(const std::string& arguments) {
    const auto environment = screen_->environment();
    const std::string command = fmt::format("DISPLAY={} xdotool {}", environment.at("DISPLAY"), arguments);
    ASSERT_EQ(std::system(command.c_str()), 0) << command;
    pause(0.1);
  }
  void key(const std::string& name) { xdotool("key --delay 40 " + name); }

  /// The middle of the viewport of a 1280 x 720 window: ui/layout.h gives x 332..998, y 30..532. The mouse stays in the
  /// viewport but out of this part: the server draws its pointer into the framebuffer.
  Picture viewport() const { return screen_->grab(400, 100, 500, 380); }

  /// Waits until the program sleeps (no processor time in 1.5 s: nothing more will change) and `region` has stayed the
  /// same meanwhile and satisfies `wanted`; false after `seconds`.
  bool settles(const std::function<Picture()>& region, const std::function<bool(const Picture&)>& wanted,
               double seconds = 120) {
    for (const auto end = Clock::now() + std::chrono::duration<double>(seconds); Clock::now() < end;) {
      if (!window_->running()) return false;
      const Picture before = region();
      const double used = window_->cpuSeconds();
      pause(1.5);
      if (window_->cpuSeconds() - used <= 0.02 && region() == before && wanted(before)) return true;
    }
    return false;
  }
  bool viewportSettles(const std::function<bool(const Picture&)>& wanted) {
    return settles([this] { return viewport(); }, wanted);
  }

  test::TemporaryFolder folder_;
  std::unique_ptr<VirtualScreen> screen_;
  std::unique_ptr<Process> window_;
};

const auto lit = [](const Picture& p) { return p.meanLuminance() > 0.05 && p.deviation() > 0.02; };

TEST_F(WindowTest, ShowsBoxAndAnswersKeysAndMouse) {
  start();
  ASSERT_TRUE(viewportSettles(lit)) << "mean " << viewport().meanLuminance() << ", deviation "
                                    << viewport().deviation();
  const Picture first = viewport();
  EXPECT_LT(first.meanLuminance(), 0.9);
  // The panels hold text: both columns and the strip vary.
  EXPECT_GT(screen_->grab(5, 40, 310, 600).deviation(), 0.03);
  EXPECT_GT(screen_->grab(1010, 40, 260, 600).deviation(), 0.03);
  EXPECT_GT(screen_->grab(340, 540, 400, 100).deviation(), 0.03);

  // What settles() waits for is stated once: an idle window does no work, no picture and no processor time.
  xdotool("mousemove 360 510");
  ASSERT_TRUE(viewportSettles([&](const Picture& p) { return p == first; }));
  const double used = window_->cpuSeconds();
  pause(3);
  EXPECT_LE(window_->cpuSeconds() - used, 0.05) << "seconds of processor time in 3 s of idling";

  // Another view and back: another picture, and the very same bits.
  key("2");
  ASSERT_TRUE(viewportSettles([&](const Picture& p) { return p.difference(first) > 0.05; })) << "key 2 changed nothing";
  key("1");
  ASSERT_TRUE(viewportSettles([&](const Picture& p) { return p == first; })) << "key 1 did not bring the picture back";

  // W flies forward.
  xdotool("keydown w sleep 0.4 keyup w");
  ASSERT_TRUE(viewportSettles([&](const Picture& p) { return lit(p) && p.difference(first) > 0.2; }))
      << "W changed nothing";

  // A right drag looks around.
  const Picture nearer = viewport();
  xdotool("mousemove 360 510 sleep 0.4 mousedown 3 sleep 0.4 mousemove 420 515 sleep 0.4 mouseup 3");
  ASSERT_TRUE(viewportSettles([&](const Picture& p) { return p.difference(nearer) > 0.2; }))
      << "the drag changed nothing";

  // C returns to a camera of the scene: from the first to the second, and round to the first again.
  key("c");
  key("c");
  ASSERT_TRUE(viewportSettles([&](const Picture& p) { return p == first; }))
      << "C twice did not return to the first camera";

  // F12 saves the view.
  key("F12");
  const std::filesystem::path png = folder_.path / "out/captures/box.lit.001.png";
  const std::filesystem::path exr = folder_.path / "out/captures/box.lit.001.exr";
  for (int i = 0; i < 300 && !(std::filesystem::exists(png) && std::filesystem::exists(exr)); ++i) pause(0.1);
  EXPECT_TRUE(std::filesystem::exists(png));
  EXPECT_TRUE(std::filesystem::exists(exr));

  key("Escape");
  EXPECT_EQ(window_->wait(20), 0) << "status after Esc, with validation on";
}

TEST_F(WindowTest, HelpAndHiddenPanelsComeAndGo) {
  start();
  ASSERT_TRUE(viewportSettles(lit));
  xdotool("mousemove 360 510");
  const Picture first = viewport();
  const auto column = [this] { return screen_->grab(5, 40, 310, 600); };
  const Picture panels = column();

  key("F1");
  ASSERT_TRUE(viewportSettles([&](const Picture& p) { return p.difference(first) > 0.1; })) << "F1 shows nothing";
  key("F1");
  ASSERT_TRUE(viewportSettles([&](const Picture& p) { return p == first; }));

  key("F2");
  ASSERT_TRUE(settles(column, [&](const Picture& p) { return p.difference(panels) > 0.5; })) << "F2 hides nothing";
  key("F2");
  ASSERT_TRUE(settles(column, [&](const Picture& p) { return p.difference(panels) < 0.05; }));

  key("Escape");
  EXPECT_EQ(window_->wait(20), 0);
}

TEST_F(WindowTest, FollowsItsSize) {
  start();
  ASSERT_TRUE(viewportSettles(lit));
  const auto resize = [&](int width, int height) {
    xdotool(fmt::format("search --onlyvisible --name irad windowsize --sync {} {}", width, height));
  };
  // Beyond the old right edge there is nothing; after growing, the right column is there.
  const auto right = [this] { return screen_->grab(1300, 50, 280, 600); };
  EXPECT_EQ(right().deviation(), 0.0);
  resize(1600, 900);
  ASSERT_TRUE(settles(right, [](const Picture& p) { return p.deviation() > 0.03; })) << "the window did not grow";
  ASSERT_TRUE(viewportSettles(lit));
  // Too small for anything, and back.
  resize(40, 30);
  pause(1);
  ASSERT_TRUE(window_->running());
  resize(1280, 720);
  ASSERT_TRUE(viewportSettles(lit));

  xdotool("mousemove 360 510");
  key("Escape");
  EXPECT_EQ(window_->wait(20), 0);
}

TEST_F(WindowTest, ScreenshotOfTheWholeWindow) {
  start({"--exit-after", "3", "--screenshot", "window.png"});
  ASSERT_EQ(window_->wait(120), 0);
  // The PNG header's width and height.
  const std::string png = readText(folder_.path / "window.png");
  ASSERT_GT(png.size(), 10000u);
  const auto word = [&](size_t at) {
    uint32_t value = 0;
    for (size_t b = 0; b < 4; ++b) value = value << 8 | static_cast<uint8_t>(png[at + b]);
    return value;
  };
  EXPECT_EQ(word(16), 1280u);
  EXPECT_EQ(word(20), 720u);
}

TEST_F(WindowTest, RefusesWhatItCannotShow) {
  window_ = std::make_unique<Process>(std::vector<std::string>{IRAD_BINARY, "view", "absent.glb"}, folder_.path,
                                      screen_->environment());
  EXPECT_EQ(window_->wait(60), 3);
  EXPECT_NE(window_->log().find("absent.glb"), std::string::npos);
  start({"--view", "lti"});
  EXPECT_EQ(window_->wait(60), 2);
  EXPECT_NE(window_->log().find("lit"), std::string::npos) << "the near match is named";
}

}  // namespace
}  // namespace irad
