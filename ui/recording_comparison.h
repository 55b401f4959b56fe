// Two recordings side by side: which folders, and what has changed between them.
#pragma once

#include <array>

#include "ui/recorder.h"

namespace irad {

/// The table of what the last comparison has found, in the rest of the region.
void drawRecordingChanges(const Recorder& recorder);

class RecordingComparison {
 public:
  /// Fills the rest of the region.
  void draw(Recorder& recorder);

 private:
  std::array<std::array<char, 1024>, 2> folders_{};  ///< as typed
};

}  // namespace irad
