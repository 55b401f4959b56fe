// Windows one after another in one process, on a device that it keeps, with the pipelines made on it: a start of the
// program makes them anew, which takes longer than most of what a test does in its window.
//
// window_host PROGRAM FD runs windows as PROGRAM would. Each is a line of JSON read from FD: its command line, the
// variables that its environment has beside the host's own, its folder, and the file that takes both standard streams.
// What is written to FD is a line with its exit status. The host ends where there is nobody at the other end any more.
#include <fcntl.h>
#include <unistd.h>

#include <cstdio>
#include <cstdlib>
#include <exception>
#include <filesystem>
#include <map>
#include <nlohmann/json.hpp>
#include <optional>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "app/command.h"
#include "app/machine.h"

namespace {

/// Set while it lives.
class Environment {
 public:
  explicit Environment(const std::map<std::string, std::string>& variables) {
    for (const auto& [name, value] : variables) {
      const char* before = std::getenv(name.c_str());
      before_.emplace_back(name, before ? std::optional<std::string>(before) : std::nullopt);
      ::setenv(name.c_str(), value.c_str(), /*overwrite=*/1);
    }
  }
  ~Environment() {
    for (const auto& [name, value] : before_)
      value ? ::setenv(name.c_str(), value->c_str(), /*overwrite=*/1) : ::unsetenv(name.c_str());
  }

 private:
  std::vector<std::pair<std::string, std::optional<std::string>>> before_;
};

int runWindow(const nlohmann::json& wanted, irad::app::Machine& machine) {
  const auto words = wanted.at("command").get<std::vector<std::string>>();
  std::vector<const char*> argv{"irad"};
  for (const std::string& word : words) argv.push_back(word.c_str());
  std::filesystem::current_path(wanted.at("folder").get<std::string>());
  const Environment environment(wanted.at("environment").get<std::map<std::string, std::string>>());
  const int log = ::open(wanted.at("log").get<std::string>().c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_APPEND, 0600);
  if (log < 0) throw std::runtime_error("no log");
  for (const int stream : {STDOUT_FILENO, STDERR_FILENO}) ::dup2(log, stream);
  ::close(log);
  const int status = irad::app::runProgram(static_cast<int>(argv.size()), argv.data(), machine);
  std::fflush(nullptr);
  return status;
}

/// A line, without its end; empty: there is no more.
std::string readLine(int file) {
  std::string line;
  for (char c = 0; ::read(file, &c, 1) == 1 && c != '\n';) line += c;
  return line;
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 3) return 2;
  irad::app::Machine machine(argv[1]);
  const int peer = std::atoi(argv[2]);
  ::fcntl(peer, F_SETFD, FD_CLOEXEC);  // not for what a window starts
  try {
    for (std::string line; !(line = readLine(peer)).empty();) {
      const std::string answer = std::to_string(runWindow(nlohmann::json::parse(line), machine)) + '\n';
      if (::write(peer, answer.data(), answer.size()) < 0) return 1;
    }
  } catch (const std::exception& error) {
    std::fprintf(stderr, "window_host: %s\n", error.what());
    return 1;
  }
}
