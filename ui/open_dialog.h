// A small browser of folders, to open scenes where nothing can be dropped.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "ui/session.h"

namespace irad {

class OpenDialog {
 public:
  /// Shown while session.showOpen; a choice is for session.open().
  void draw(Session& session);

 private:
  void enter(const std::filesystem::path& folder);
  void choose(Session& session, const std::filesystem::path& file);
  void drawEntries(Session& session);

  struct Entry {
    std::string name;
    bool folder;
  };
  std::filesystem::path folder_;
  std::vector<Entry> entries_;  ///< folders first, then scenes
  std::string typed_, error_;
};

}  // namespace irad
