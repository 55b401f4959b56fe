// Windows in a process that other windows of the suite were in before (tests/window_host.cpp).
#pragma once

#include <fcntl.h>
#include <sys/socket.h>

#include <memory>
#include <nlohmann/json.hpp>

#include "tests/virtual_screen.h"

namespace irad::test {

class WindowHost {
 public:
  /// The one of this process; begun with its first window, and anew after one that did not end.
  static std::shared_ptr<WindowHost> get() {
    if (!kept() || !kept()->program_.running()) kept() = std::make_shared<WindowHost>();
    return kept();
  }
  WindowHost() : WindowHost(ends()) {}
  ~WindowHost() {
    lastingProcesses().erase(program_.pid());
    close(peer_);
  }
  WindowHost(const WindowHost&) = delete;

 private:
  friend class HostedWindow;
  static std::shared_ptr<WindowHost>& kept() {
    static std::shared_ptr<WindowHost> host;
    return host;
  }
  static std::array<int, 2> ends() {
    std::array<int, 2> ends{};
    if (socketpair(AF_UNIX, SOCK_STREAM, 0, ends.data()) != 0) throw std::runtime_error("socketpair");
    fcntl(ends[0], F_SETFD, FD_CLOEXEC);
    return ends;
  }
  explicit WindowHost(const std::array<int, 2>& ends)
      : peer_(ends[0]),
        program_({(buildFolder() / "tests/window_host").string(), iradProgram(), std::to_string(ends[1])}, folder_.path,
                 {}) {
    close(ends[1]);
    lastingProcesses().insert(program_.pid());
  }

  TemporaryFolder folder_;
  int peer_;
  Program program_;
};

/// As Program, for the command lines of `irad`.
class HostedWindow : public Running {
 public:
  HostedWindow(const std::vector<std::string>& command, const std::filesystem::path& folder,
               const std::map<std::string, std::string>& environment)
      : Running(folder / "irad.log"), host_(WindowHost::get()) {
    const std::string line = nlohmann::json{{"command", std::vector(command.begin() + 1, command.end())},
                                            {"environment", environment},
                                            {"folder", folder.string()},
                                            {"log", (folder / "irad.log").string()}}
                                 .dump() +
                             '\n';
    std::filesystem::remove(folder / "irad.log");  // what the window before has said
    if (send(host_->peer_, line.data(), line.size(), MSG_NOSIGNAL) != static_cast<ssize_t>(line.size()))
      throw std::runtime_error("the windows' host takes none: " + host_->program_.log());
  }
  /// Another window cannot come where this one still is.
  ~HostedWindow() override {
    if (running()) host_->program_.killNow();
  }
  void killNow() override { host_->program_.killNow(); }

 private:
  pid_t pid() const override { return host_->program_.pid(); }
  std::optional<int> poll() override {
    for (char c = 0; !status_ && recv(host_->peer_, &c, 1, MSG_DONTWAIT) == 1;)
      if (c != '\n')
        answer_ += c;
      else
        status_ = std::stoi(answer_);
    if (!status_ && !host_->program_.running()) status_ = host_->program_.wait(0);
    return status_;
  }

  std::shared_ptr<WindowHost> host_;
  std::string answer_;
  std::optional<int> status_;
};

}  // namespace irad::test
