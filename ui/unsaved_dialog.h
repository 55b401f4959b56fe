// Save, Discard, Cancel: what is asked before something unsaved is lost.
#pragma once

#include <filesystem>
#include <string>

#include "ui/session.h"

namespace irad {

class UnsavedDialog {
 public:
  /// Lights and bookmarks that have no place of their own are offered one in `folder`.
  explicit UnsavedDialog(std::filesystem::path folder) : folder_(std::move(folder)) {}
  /// Shown while session.asking.
  void draw(Session& session);

 private:
  void begin(const Session& session);
  bool drawRows(Session& session, const Unsaved& unsaved);
  void save(Session& session, const Unsaved& unsaved);

  std::filesystem::path folder_;
  std::string file_;               ///< of lights and bookmarks without a place
  std::string presetA_, presetB_;  ///< names, being typed
  std::string error_;              ///< of the last attempt to save
};

}  // namespace irad
