// runIrad: the program's commands in the process of the tests.
#include <fcntl.h>
#include <unistd.h>

#include <csignal>
#include <cstdio>

#include "app/command.h"
#include "app/machine.h"
#include "tests/support.h"

namespace irad::test {
namespace {

/// Standard output and standard error go to files while it lives; what the program makes of signals ends with it.
class Aside {
 public:
  Aside(const std::filesystem::path& out, const std::filesystem::path& err) {
    std::fflush(nullptr);
    const std::filesystem::path* files[] = {&out, &err};
    for (int i = 0; i < 2; ++i) {
      kept_[i] = ::fcntl(kStreams[i], F_DUPFD_CLOEXEC, 3);
      const int file = ::open(files[i]->c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_APPEND | O_CLOEXEC, 0600);
      EXPECT_TRUE(kept_[i] >= 0 && ::dup2(file, kStreams[i]) >= 0);
      ::close(file);
    }
    for (size_t i = 0; i < std::size(kSignals); ++i) ::sigaction(kSignals[i], nullptr, &signals_[i]);
  }
  ~Aside() {
    std::fflush(nullptr);
    for (int i = 0; i < 2; ++i) {
      ::dup2(kept_[i], kStreams[i]);
      ::close(kept_[i]);
    }
    for (size_t i = 0; i < std::size(kSignals); ++i) ::sigaction(kSignals[i], &signals_[i], nullptr);
  }

 private:
  static constexpr int kStreams[] = {STDOUT_FILENO, STDERR_FILENO};
  static constexpr int kSignals[] = {SIGPIPE, SIGXFSZ, SIGINT, SIGTERM};
  int kept_[2];
  struct sigaction signals_[std::size(kSignals)];
};

}  // namespace

RunResult runIrad(const std::vector<std::string>& arguments) {
  static app::Machine machine(iradProgram());
  std::vector<const char*> argv{"irad"};
  for (const std::string& argument : arguments) argv.push_back(argument.c_str());
  const TemporaryFolder folder;
  RunResult result;
  {
    const Aside aside(folder.path / "out", folder.path / "err");
    result.status = app::runProgram(static_cast<int>(argv.size()), argv.data(), machine);
  }
  result.out = slurp(folder.path / "out");
  result.err = slurp(folder.path / "err");
  return result;
}

}  // namespace irad::test
