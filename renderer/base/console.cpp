#include "renderer/base/console.h"

#include <fcntl.h>
#include <unistd.h>

#include <cerrno>
#include <csignal>
#include <cstdio>
#include <cstring>

#include "renderer/base/error.h"

namespace irad {
namespace {

[[noreturn]] void failToPrint() {
  throw WorkError(fmt::format("cannot write to standard output: {}", std::strerror(errno)));
}

}  // namespace

void holdStandardStreams() {
  std::signal(SIGPIPE, SIG_IGN);
  // This takes the lowest free number, that of the closed stream. It is opened in the wrong direction, so that using it
  // still fails.
  for (const int stream : {STDIN_FILENO, STDOUT_FILENO, STDERR_FILENO})
    if (::fcntl(stream, F_GETFD) < 0) (void)::open("/dev/null", stream == STDIN_FILENO ? O_WRONLY : O_RDONLY);
}

void writeStandardError(std::string_view text) noexcept {
  (void)std::fwrite(text.data(), 1, text.size(), stderr);
  (void)std::fflush(stderr);
}

void writeStandardOutput(std::string_view text) {
  if (std::fwrite(text.data(), 1, text.size(), stdout) != text.size()) failToPrint();
}

void flushStandardOutput() {
  if (std::fflush(stdout) != 0) failToPrint();
}

}  // namespace irad
