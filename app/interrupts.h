// Ctrl+C and SIGTERM for work that takes long and is kept on disk: what is in hand is finished, and the program ends
// with a message. A second one ends it at once.
#pragma once

#include <csignal>

namespace irad::app {

/// While it lives a first signal is only noted.
class StopOnSignal {
 public:
  StopOnSignal();
  ~StopOnSignal();
  StopOnSignal(const StopOnSignal&) = delete;
  bool came() const;  ///< since it began

 private:
  struct sigaction interrupt_ {
  }, terminate_{};
};
/// Whether a signal was noted.
bool isStopped();
/// WorkError where one was.
void throwIfStopped();

}  // namespace irad::app
