// What the program prints: results on standard output, all else on standard error. Either may be closed, full or a pipe
// that nobody reads any more, and neither may end the program other than by an exit status.
#pragma once

#include <fmt/core.h>

#include <string>
#include <string_view>

namespace irad {

/// To be called first: where one of the three standard streams is closed, no file that is opened later takes its place
/// (and with it what is printed), and writing to a pipe without a reader fails like any other write.
void holdStandardStreams();

/// A text as a terminal can take it, whatever names it quotes from files and command lines: bytes that are no UTF-8,
/// and control characters other than line feeds and tabs, become "\xNN".
std::string printable(std::string_view text);

void writeStandardError(std::string_view text) noexcept;  ///< as it is; what cannot be written is lost
void writeStandardOutput(std::string_view text);          ///< as it is; WorkError where it cannot be written
void flushStandardOutput();                               ///< what is buffered; WorkError where it cannot be written

/// Messages and errors, printable().
template <class... T>
void tell(fmt::format_string<T...> format, const T&... values) noexcept {
  try {
    writeStandardError(printable(fmt::vformat(format, fmt::make_format_args(values...))));
  } catch (...) {  // no memory for the text
  }
}
/// Results, printable(). WorkError where they cannot be written.
template <class... T>
void print(fmt::format_string<T...> format, const T&... values) {
  writeStandardOutput(printable(fmt::vformat(format, fmt::make_format_args(values...))));
}

}  // namespace irad
