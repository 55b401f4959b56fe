// A virtual X server of a suite's own, processes in it, synthetic keys and mouse, and what its screen shows.
#pragma once

#include <fmt/format.h>
#include <gtest/gtest.h>
#include <signal.h>
#include <unistd.h>

#include <chrono>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <map>
#include <optional>
#include <sstream>
#include <thread>

#include "gi/check/process.h"
#include "tests/support.h"
#include "tests/synthetic_input.h"

namespace irad::test {

using Clock = std::chrono::steady_clock;

/// What a busy machine may take for what an idle one does in seconds: the first window of a machine compiles every
/// pipeline, and six windows share two cores with a compiler.
constexpr std::chrono::seconds kPatience{300};

inline void pause(double seconds) {
  std::this_thread::sleep_for(std::chrono::duration<double>(seconds));
}

/// Per thread of a process, but for one, how often it has run; nothing while one of them runs, or waits for a processor
/// or a disk. If it is the same twice, the process slept in between, however busy the machine is.
inline std::optional<std::string> threadsAsleep(pid_t process, pid_t except = 0) {
  std::string runs;
  for (const auto& thread : std::filesystem::directory_iterator(fmt::format("/proc/{}/task", process))) {
    if (thread.path().filename() == std::to_string(except)) continue;
    std::ifstream status(thread.path() / "status");
    for (std::string line; std::getline(status, line);) {
      if (line.starts_with("State:") && line.find("S (") == std::string::npos) return std::nullopt;
      if (line.find("_ctxt_switches:") != std::string::npos) runs += line + ' ';
    }
  }
  return runs;
}

/// What runs beside the test, in a process, and prints into a file.
class Running {
 public:
  explicit Running(std::filesystem::path log) : log_(std::move(log)) {}
  virtual ~Running() = default;
  Running(const Running&) = delete;
  Running& operator=(const Running&) = delete;

  /// Ends the process at once, as a crash would.
  virtual void killNow() = 0;
  bool running() { return !poll(); }
  /// Exit status, or -1 when it still runs after `seconds`.
  int wait(double seconds) {
    for (const auto end = Clock::now() + std::chrono::duration<double>(seconds); running();) {
      if (Clock::now() > end) return -1;
      pause(0.02);
    }
    return *poll();
  }
  /// Processor time used so far by all threads of the process, seconds.
  double cpuSeconds() const { return processorSeconds(pid()); }
  std::optional<std::string> asleep() const { return threadsAsleep(pid()); }
  std::string log() const { return slurp(log_); }

 private:
  virtual pid_t pid() const = 0;
  virtual std::optional<int> poll() = 0;  ///< the exit status; none while it runs
  std::filesystem::path log_;
};

/// A program in a folder and an environment of its own, what it prints in a file there. It ends with the test, even a
/// test that is killed; therefore the thread that starts it must live as long.
class Program : public Running {
 public:
  Program(const std::vector<std::string>& command, const std::filesystem::path& folder,
          const std::map<std::string, std::string>& environment)
      : Program(command, folder, environment,
                folder / (std::filesystem::path(command[0]).filename().string() + ".log")) {}
  /// Asked to end first, so that a server removes its lock and socket.
  ~Program() override {
    if (!running()) return;
    kill(process_.pid(), SIGTERM);
    wait(5);
  }

  void killNow() override {
    kill(process_.pid(), SIGKILL);
    wait(60);  // until then it holds its files' locks
  }
  pid_t pid() const override { return process_.pid(); }

 private:
  Program(const std::vector<std::string>& command, const std::filesystem::path& folder,
          const std::map<std::string, std::string>& environment, const std::filesystem::path& log)
      : Running(log), process_("/usr/bin/setpriv", throughEnv(command, folder, environment), log, log) {}
  std::optional<int> poll() override { return process_.poll(); }
  /// setpriv(1) becomes env(1), and that the program: the process is the same.
  static std::vector<std::string> throughEnv(const std::vector<std::string>& command,
                                             const std::filesystem::path& folder,
                                             const std::map<std::string, std::string>& environment) {
    std::vector<std::string> words{"--pdeathsig", "TERM", "/usr/bin/env", "-C", folder.string()};
    for (const auto& [name, value] : environment) words.push_back(name + "=" + value);
    words.insert(words.end(), command.begin(), command.end());
    return words;
  }
  Process process_;
};

inline bool installed(const std::string& program) {
  return std::system(fmt::format("command -v {} >/dev/null 2>&1", program).c_str()) == 0;
}

/// A part of the screen, RGB.
struct ScreenPart {
  int width = 0, height = 0;
  std::vector<uint8_t> rgb;
  bool operator==(const ScreenPart&) const = default;
  /// Channel 0 to 2 of a pixel.
  template <class Self>
  static auto& channel(Self& self, int x, int y, int c) {
    return self.rgb.at(3 * (static_cast<size_t>(y) * static_cast<size_t>(self.width) + static_cast<size_t>(x)) +
                       static_cast<size_t>(c));
  }
  uint8_t at(int x, int y, int c) const { return channel(*this, x, y, c); }
  uint8_t& at(int x, int y, int c) { return channel(*this, x, y, c); }

  /// Pixels of this colour (0xRRGGBB).
  int count(uint32_t color) const {
    int n = 0;
    for (size_t i = 0; i + 2 < rgb.size(); i += 3)
      n += (uint32_t{rgb[i]} << 16 | uint32_t{rgb[i + 1]} << 8 | rgb[i + 2]) == color;
    return n;
  }
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
  double difference(const ScreenPart& other) const {
    if (rgb.size() != other.rgb.size()) return 1;
    size_t differing = 0;
    for (size_t i = 0; i + 2 < rgb.size(); i += 3)
      differing += rgb[i] != other.rgb[i] || rgb[i + 1] != other.rgb[i + 1] || rgb[i + 2] != other.rgb[i + 2];
    return static_cast<double>(differing) / static_cast<double>(rgb.size() / 3);
  }
  /// By how much channels differ in the mean, of 255.
  double levels(const ScreenPart& other) const {
    if (rgb.size() != other.rgb.size()) return 255;
    double sum = 0;
    for (size_t i = 0; i < rgb.size(); ++i) sum += std::abs(int{other.rgb[i]} - int{rgb[i]});
    return sum / static_cast<double>(rgb.size());
  }
};

/// Xvfb on a free display, its framebuffer readable as a file.
class VirtualScreen {
 public:
  VirtualScreen(int width, int height) {
    int fds[2] = {};
    if (pipe(fds) != 0) throw std::runtime_error("pipe");
    // -noreset: otherwise it restarts whenever its last client leaves, and refuses connections meanwhile. -r: a key
    // that is held is one event. -dumbSched: otherwise the timer of its scheduler now and then goes on after the last
    // request, and the server never sleeps.
    server_ = std::make_unique<Program>(
        std::vector<std::string>{"Xvfb", "-displayfd", std::to_string(fds[1]), "-screen", "0",
                                 fmt::format("{}x{}x24", width, height), "-fbdir", folder_.path.string(), "-nolisten",
                                 "tcp", "-noreset", "-r", "-dumbSched"},
        folder_.path, std::map<std::string, std::string>{});
    close(fds[1]);
    // "N\n", written in two pieces: closing early would kill the server with SIGPIPE.
    std::string number;
    for (char c = 0; c != '\n' && read(fds[0], &c, 1) == 1;) number += c;
    close(fds[0]);
    if (number.empty()) throw std::runtime_error("Xvfb did not start: " + server_->log());
    display_ = fmt::format(":{}", std::atoi(number.c_str()));
    input_ = std::make_unique<SyntheticInput>(display_);
  }
  std::map<std::string, std::string> environment() const {
    return {
        {"DISPLAY", display_}, {"XDG_SESSION_TYPE", "x11"}, {"XDG_CONFIG_HOME", (folder_.path / "config").string()}};
  }

  const std::string& display() const { return display_; }
  const Program& server() const { return *server_; }
  SyntheticInput& input() const { return *input_; }
  /// Keys, mouse and window.
  void act(const std::string& commands) const { input_->act(commands); }
  void key(const std::string& name) const { act("key --delay 40 " + name); }

  /// The framebuffer is in the XWD format: big-endian header, then rows of BGRX.
  ScreenPart grab(int x, int y, int width, int height) const {
    std::ifstream file(folder_.path / "Xvfb_screen0", std::ios::binary);
    const auto read = [&](size_t from, std::string& into) {
      file.seekg(static_cast<std::streamoff>(from));
      if (!file.read(into.data(), static_cast<std::streamsize>(into.size())))
        throw std::runtime_error("beyond the screen");
    };
    std::string header(80, 0);
    read(0, header);
    const auto word = [&](size_t i) {
      uint32_t value = 0;
      for (size_t b = 0; b < 4; ++b) value = value << 8 | static_cast<uint8_t>(header.at(4 * i + b));
      return value;
    };
    const size_t pixels = word(0) + 12 * size_t{word(19)}, row = word(12), depth = word(11) / 8;
    ScreenPart picture{width, height, {}};
    if (width <= 0 || height <= 0) return picture;
    picture.rgb.reserve(3 * static_cast<size_t>(width) * static_cast<size_t>(height));
    std::string line(depth * static_cast<size_t>(width), 0);
    for (int j = y; j < y + height; ++j) {
      read(pixels + row * static_cast<size_t>(j) + depth * static_cast<size_t>(x), line);
      for (size_t i = 0; i < line.size(); i += depth)
        for (size_t c = 3; c-- > 0;) picture.rgb.push_back(static_cast<uint8_t>(line[i + c]));
    }
    return picture;
  }

 private:
  TemporaryFolder folder_;
  std::unique_ptr<Program> server_;
  std::string display_;
  std::unique_ptr<SyntheticInput> input_;
};

}  // namespace irad::test
