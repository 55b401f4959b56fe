// Progress on standard error: a bar on a terminal, a plain line per step otherwise.
#pragma once

#include <string>

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

/// "2 h 05 min left"
std::string timeLeft(double seconds);

}  // namespace irad::app
