// Against crashes: what is unsaved is in a file soon after an edit is done, and not there any more once it is saved.
// What an earlier run has left is offered. A disk may take long: the window's `writer` writes, and holds up no frame.
#pragma once

#include <filesystem>
#include <optional>

#include "ui/autosave.h"
#include "ui/background_worker.h"
#include "ui/edit_state.h"

namespace irad {

struct Session;

class WorkKeeper {
 public:
  /// Beside the user's preferences; where these have no file, nothing is kept and nothing is found.
  WorkKeeper(const std::filesystem::path& preferences, BackgroundWorker& writer);
  ~WorkKeeper() { writer_.wait(); }  ///< what was to be kept is

  /// As of the present step of the history; to be called again and again, since what is due waits for what is being
  /// written, and taken from the writer. Where that has failed the user is told, once, and the next edit is tried
  /// again.
  void keep(Session& session);
  /// At once: true where all that is unsaved is in the file.
  bool keepNow(Session& session);
  /// Puts what another run has left into Session::found; none where there is no more.
  void offer(Session& session);
  /// What was found is in this run's file now, or not wanted.
  void removeFound();
  /// It waits for another start.
  void leaveFound();
  /// All of it was saved or discarded.
  void end();

 private:
  bool none_;
  BackgroundWorker& writer_;  ///< has autosaves_ while it works
  Autosaves autosaves_;
  std::optional<EditState> kept_;  ///< what the file holds, or was to hold; none: nothing is unsaved
  bool failed_ = false;            ///< the last time
  bool told_ = false;
};

}  // namespace irad
