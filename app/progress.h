// Progress on standard error: a bar on a terminal, a plain line per step otherwise.
#pragma once

#include <filesystem>
#include <optional>
#include <string>

namespace irad {
struct Config;
}

namespace irad::app {

class ProgressReport {
 public:
  ProgressReport();
  ~ProgressReport() { finish(); }
  /// `fraction` 0..1 of `step`. Returns true: go on. `remark`: shown behind the bar, such as timeLeft().
  bool operator()(const char* step, float fraction, const std::string& remark = {});
  /// A line of its own that does not tear the bar apart.
  void note(const std::string& line);
  void finish();  ///< takes the bar away, before results are printed

 private:
  bool terminal_;
  std::string step_, remark_;
  int percent_ = -1;
  bool barShown_ = false;
};

/// Warns where a file is not the one that the config `named` by its SHA-256.
void warnIfOther(ProgressReport& progress, const Config& config, const std::filesystem::path& path,
                 const std::string& sha256, const std::optional<std::string>& named);

std::string duration(double seconds);  ///< "45 s", "3 min 07 s", "2 h 05 min"
std::string timeLeft(double seconds);  ///< "2 h 05 min left"

}  // namespace irad::app
