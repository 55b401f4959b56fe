// Another program run beside this one.
#pragma once

#include <sys/types.h>

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace irad {

/// Among the folders of PATH, as a shell finds it; empty: it is not installed.
std::filesystem::path findProgram(const std::string& name);

/// A running program; killed with its object. Its standard input is empty.
class Process {
 public:
  /// `out`, `err`: files for its two streams. Throws WorkError where it cannot be started.
  Process(const std::string& program, const std::vector<std::string>& arguments,
          const std::filesystem::path& out = "/dev/null", const std::filesystem::path& err = "/dev/null");
  ~Process();
  Process(const Process&) = delete;
  Process& operator=(const Process&) = delete;

  pid_t pid() const { return pid_; }
  /// Exit status as a shell reports it (128 + signal); none while it runs.
  std::optional<int> poll() { return look(/*block=*/false); }
  int wait() { return *look(/*block=*/true); }
  /// With SIGKILL, unless it has ended; its status.
  int kill();

 private:
  std::optional<int> look(bool block);
  pid_t pid_ = 0;
  std::optional<int> status_;
};

}  // namespace irad
