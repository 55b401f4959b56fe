#include "renderer/base/console.h"

#include <fcntl.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <csignal>
#include <cstdint>
#include <cstdio>
#include <cstring>

#include "renderer/base/error.h"

namespace irad {
namespace {

[[noreturn]] void failToPrint() {
  throw WorkError(fmt::format("cannot write to standard output: {}", std::strerror(errno)));
}

/// Bytes of the UTF-8 character that begins here (Unicode 15, table 3-7); 0: there is none.
size_t utf8Length(std::string_view text) {
  const auto byte = [&](size_t i) { return i < text.size() ? static_cast<uint8_t>(text[i]) : uint8_t{0}; };
  const uint8_t first = byte(0);
  if (first < 0x80) return 1;
  const size_t length = first >= 0xC2 && first <= 0xDF   ? 2
                        : (first & 0xF0) == 0xE0         ? 3
                        : first >= 0xF0 && first <= 0xF4 ? 4
                                                         : 0;
  for (size_t i = 1; i < length; ++i)
    if ((byte(i) & 0xC0) != 0x80) return 0;
  const uint8_t second = byte(1);
  const bool overlong = (first == 0xE0 && second < 0xA0) || (first == 0xF0 && second < 0x90);
  const bool beyond = (first == 0xED && second > 0x9F) /* surrogates */ || (first == 0xF4 && second > 0x8F);
  return overlong || beyond ? 0 : length;
}

}  // namespace

std::string printable(std::string_view text) {
  std::string out;
  out.reserve(text.size());
  while (!text.empty()) {
    const size_t length = utf8Length(text);
    const auto first = static_cast<uint8_t>(text[0]);
    const bool control = (first < 0x20 && first != '\n' && first != '\t') || first == 0x7F ||
                         (length == 2 && first == 0xC2 && static_cast<uint8_t>(text[1]) < 0xA0);
    const size_t taken = std::max<size_t>(length, 1);
    if (length == 0 || control)
      for (const char c : text.substr(0, taken)) out += fmt::format("\\x{:02X}", static_cast<uint8_t>(c));
    else
      out += text.substr(0, taken);
    text.remove_prefix(taken);
  }
  return out;
}

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
