// What the window remembers between runs: one JSON file in the user's configuration folder.
#pragma once

#include <filesystem>
#include <set>
#include <string>
#include <vector>

#include "ui/layout.h"

namespace irad {

/// The effects that are off, in the panel of that name.
inline constexpr const char* kEffectsOff = "Effects/off";

struct Preferences {
  PanelSizes sizes;
  /// Titles of panels and columns, "Settings/GROUP", and kEffectsOff. At first those panels are folded that would push
  /// the settings and the effects out of a window of 720 lines, and the strip, which would take a third of the picture.
  std::set<std::string> folded = foldedAtFirst();
  std::vector<std::filesystem::path> recent;  ///< scenes, absolute, the last one first

  /// Times the monitor's own scale, from kSmallest to kLargest; 0: as the command line says, or 1.
  float scale = 0;
  static constexpr float kSmallest = 0.75f, kLargest = 3;

  bool applyByHand = false;  ///< settings that rebuild wait for the button Apply

  bool operator==(const Preferences&) const = default;
  Folding folding() const;
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
