#include "app/progress.h"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <cstdint>

#include "gi/config.h"
#include "renderer/base/console.h"

namespace irad::app {

constexpr const char* kClearLine = "\r\x1b[K";  // of a terminal

ProgressReport::ProgressReport() : terminal_(::isatty(STDERR_FILENO) == 1) {}

void ProgressReport::finish() {
  if (barShown_) writeStandardError(kClearLine);
  barShown_ = false;
}

void warnIfOther(ProgressReport& progress, const Config& config, const std::filesystem::path& path,
                 const std::string& sha256, const std::optional<std::string>& named) {
  if (named && *named != sha256)
    progress.note(fmt::format("warning: {} is not the file that {} names: SHA-256 {} instead of {}", path.string(),
                              config.path.string(), sha256, *named));
}

std::string duration(double seconds) {
  const auto s = static_cast<int64_t>(std::clamp(seconds, 0.0, 1e12) + 0.5);
  if (s < 60) return fmt::format("{} s", s);
  if (s < 3600) return fmt::format("{} min {:02} s", s / 60, s % 60);
  return fmt::format("{} h {:02} min", s / 3600, s / 60 % 60);
}

std::string timeLeft(double seconds) {
  return duration(seconds) + " left";
}

bool ProgressReport::operator()(const char* step, float fraction, const std::string& remark) {
  const int percent = static_cast<int>(100.0f * std::clamp(fraction, 0.0f, 1.0f));
  const bool fresh = step_ != step;
  if (!fresh && percent == percent_ && remark == remark_) return true;
  step_ = step;
  percent_ = percent;
  remark_ = remark;
  if (terminal_) {
    const int filled = percent * 30 / 100;
    writeStandardError(kClearLine);
    tell("[{:#<{}}{:.<{}}] {:3} % {}{}{}", "", filled, "", 30 - filled, percent, step, remark.empty() ? "" : ", ",
         remark);
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
