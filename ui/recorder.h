// Tables and recordings that the window writes, and recordings that it compares: between frames.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "renderer/base/compare_timings.h"

namespace irad {

struct Session;

struct Recorder {
  std::optional<double> began;                    ///< while a recording runs: Timings::now() of its start
  std::vector<std::filesystem::path> recordings;  ///< in the captures folder, as of the start or the last one written
  std::vector<StageChange> changes;               ///< of the last comparison

  // Requests.
  bool toggle = false;  ///< starts a recording, or ends and writes it
  bool memory = false;  ///< writes the memory table
  std::optional<std::pair<std::filesystem::path, std::filesystem::path>> compare;
};

/// Does what is asked for; new folders in `folder`. While a recording runs pictures follow each other without pause.
/// What goes wrong is said in the window.
void serveRecorder(Session& session, const std::filesystem::path& folder);

}  // namespace irad
