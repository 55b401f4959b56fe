#include "app/progress.h"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>

#include "renderer/base/console.h"

namespace irad::app {

ProgressReport::ProgressReport() : terminal_(::isatty(STDERR_FILENO) == 1) {}

void ProgressReport::finish() {
  if (barShown_) tell("\r\x1b[K");
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
    tell("\r\x1b[K[{:#<{}}{:.<{}}] {:3} % {}", "", filled, "", 30 - filled, percent, step);
    barShown_ = true;
  } else if (fresh) {
    tell("{}\n", step);
  }
  return true;
}

void ProgressReport::note(const std::string& line) {
  finish();
  tell("{}\n", line);
}

}  // namespace irad::app
