#include "app/progress.h"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <cstdio>

namespace irad::app {

ProgressReport::ProgressReport() : terminal_(::isatty(STDERR_FILENO) == 1) {}

void ProgressReport::finish() {
  if (barShown_) fmt::print(stderr, "\r\x1b[K");
  barShown_ = false;
}

bool ProgressReport::operator()(const char* step, float fraction) {
  const int percent = static_cast<int>(100.0f * std::clamp(fraction, 0.0f, 1.0f));
  const bool fresh = step_ != step;
  if (!fresh && percent == percent_) return true;
  step_ = step;
  percent_ = percent;
  if (terminal_) {
    const int filled = percent * 30 / 100;
    fmt::print(stderr, "\r\x1b[K[{:#<{}}{:.<{}}] {:3} % {}", "", filled, "", 30 - filled, percent, step);
    std::fflush(stderr);
    barShown_ = true;
  } else if (fresh) {
    fmt::print(stderr, "{}\n", step);
  }
  return true;
}

void ProgressReport::note(const std::string& line) {
  finish();
  fmt::print(stderr, "{}\n", line);
}

}  // namespace irad::app
