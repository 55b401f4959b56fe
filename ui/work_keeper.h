// Against crashes: what is unsaved is in a file as soon as an edit is done, and not there any more once it is saved.
// What an earlier run has left is offered.
#pragma once

#include <filesystem>
#include <optional>

#include "ui/autosave.h"
#include "ui/edit_state.h"

namespace irad {

struct Session;

class WorkKeeper {
 public:
  /// Beside the user's preferences; where these have no file, nothing is kept and nothing is found.
  explicit WorkKeeper(const std::filesystem::path& preferences);

  /// After an edit, as of the present step of the history. Where it fails the user is told, once, and the next edit is
  /// tried again. True where all that is unsaved is in the file.
  bool keep(Session& session);
  /// Puts what another run has left into Session::found; none where there is no more.
  void offer(Session& session);
  /// What was found is in this run's file now, or not wanted.
  void removeFound() { autosaves_.removeFound(); }
  /// It waits for another start.
  void leaveFound() { autosaves_.leaveFound(); }
  /// All of it was saved or discarded.
  void end() { autosaves_.removeKept(); }

 private:
  bool none_;
  Autosaves autosaves_;
  std::optional<EditState> kept_;  ///< what the file holds, or was to hold; none: nothing is unsaved
  bool failed_ = false;            ///< the last time
  bool told_ = false;
};

}  // namespace irad
