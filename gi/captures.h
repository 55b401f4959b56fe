// A folder of captures and recordings, as their manifests describe them (gi/manifest.h).
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "gi/config.h"
#include "gi/settings.h"
#include "gi/views/views.h"

namespace irad {

struct CaptureEntry {
  std::filesystem::path folder;   ///< absolute
  std::string name;               ///< below the folder that was listed: "box.001", "box.002/a"
  int64_t time = 0;               ///< seconds since 1970, UTC: as the manifest says or, where it does not, its file
  Config config;                  ///< the manifest; of a recording of older versions, which has none, empty
  Settings settings;              ///< where the manifest is of a comparison, A's
  std::optional<Settings> other;  ///< B's
  std::optional<View> view;       ///< the first of its views
  bool recording = false;         ///< of timings (renderer/base/recording.h)
  std::filesystem::path picture;  ///< as shown, of that view or, where there is none, the first; empty: there is none
  std::filesystem::path linear;   ///< the same in numbers; empty: there is none
  bool described() const { return config.scene.has_value(); }  ///< it can be replayed
};

/// InputError names file, object and value, also where it is no manifest of a run. `defaults`: of settings that it does
/// not name.
CaptureEntry readCapture(const std::filesystem::path& manifest, const Settings& defaults);

struct CaptureList {
  std::vector<CaptureEntry> entries;  ///< the newest first
  std::vector<std::string> problems;  ///< what is in the folder and cannot be listed: file, and what is wrong with it
};
/// Of the folders in `folder` that have a manifest or frames.csv, and of those in them (the sides of a comparison). No
/// such folder: nothing.
CaptureList listCaptures(const std::filesystem::path& folder, const Settings& defaults);

}  // namespace irad
