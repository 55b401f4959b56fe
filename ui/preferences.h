// What the window remembers between runs: one JSON file in the user's configuration folder.
#pragma once

#include <filesystem>
#include <set>
#include <string>
#include <vector>

#include "ui/layout.h"

namespace irad {

struct Preferences {
  PanelSizes sizes;
  /// Titles of panels, and "Settings/GROUP". At first those are folded that would push the settings and the effects
  /// out of a window of 720 lines.
  std::set<std::string> folded = foldedAtFirst();
  std::vector<std::filesystem::path> recent;  ///< scenes, absolute, the last one first

  bool operator==(const Preferences&) const = default;
  void resetLayout();  ///< as on the first start; the scenes stay
  void opened(const std::filesystem::path& scene);

 private:
  static std::set<std::string> foldedAtFirst();
};

/// irad/window.json in $XDG_CONFIG_HOME, or in ~/.config (XDG Base Directory Specification 0.8); empty where the
/// environment names no such folder.
std::filesystem::path preferencesFile();

/// The preferences of a first start where there is no such file. InputError names file, member and value.
Preferences readPreferences(const std::filesystem::path& file);
/// Makes the folder; WorkError where that or the file cannot be written.
void writePreferences(const std::filesystem::path& file, const Preferences& preferences);

}  // namespace irad
