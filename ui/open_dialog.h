// A small browser of folders, to open scenes, pictures and saved lights where nothing can be dropped.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "ui/session.h"

struct ImGuiTableSortSpecs;

namespace irad {

class OpenDialog {
 public:
  /// Shown while session.showOpen; a choice is for session.open(). Where that fails the dialog is shown again, with
  /// session.openError in it.
  void draw(Session& session);

 private:
  enum class Kind { All, Scenes, Pictures, Sidecars };
  struct Entry {
    std::string name;
    bool folder = false;
    uint64_t bytes = 0;
    int64_t changed = 0;  ///< seconds since 1970
  };
  struct Place {
    std::string name;
    std::filesystem::path folder;
  };
  void enter(const std::filesystem::path& folder);
  void choose(Session& session, const std::string& what);
  void select();
  void sort(const ImGuiTableSortSpecs& specs);
  static bool isOpened(const std::filesystem::path& path, Kind kind);
  std::vector<Place> places(const Session& session) const;
  void drawPlaces(const Session& session, float height);
  void drawEntries(Session& session, float width, float height);

  std::filesystem::path folder_;
  std::vector<Entry> entries_;      ///< of the folder, but what is never opened
  std::vector<uint32_t> shown_;     ///< of them, as filtered and sorted: folders first
  bool sorted_ = false;             ///< shown_ is in the order that the table asks for
  std::optional<uint32_t> chosen_;  ///< of entries_
  Kind kind_ = Kind::All;
  std::string filter_, typed_, error_;
};

}  // namespace irad
