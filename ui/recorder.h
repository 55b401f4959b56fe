// Tables and recordings that the window writes, and recordings that it compares: between frames.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "renderer/base/compare_timings.h"
#include "ui/edit_state.h"

namespace irad {

struct Program;
struct Session;

struct Recorder {
  std::optional<double> began;                    ///< while a recording runs: Timings::now() of its start
  std::optional<EditState> from;                  ///< likewise: what was recorded then
  std::vector<std::filesystem::path> recordings;  ///< in the captures folder, as of the start or the last one written
  std::vector<StageChange> changes;               ///< of the last comparison
  std::string problem;                            ///< why there are none

  // Requests.
  bool toggle = false;  ///< starts a recording, or ends and writes it
  bool memory = false;  ///< writes the memory table
  std::optional<std::pair<std::filesystem::path, std::filesystem::path>> compare;
};

/// Does what is asked for; new folders in `folder`. A recording's manifest says what was shown when it ended, and what
/// changed while it ran. While a recording runs pictures follow each other without pause.
/// What goes wrong is said in the window.
void serveRecorder(Session& session, const std::filesystem::path& folder, const Program& program);

}  // namespace irad
