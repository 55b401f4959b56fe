// What is unsaved in a window, kept against a crash: a file beside the preferences, which the next start finds where
// its window has not ended properly (docs/conventions.md, "What is unsaved").
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "gi/settings.h"
#include "gi/views/views.h"
#include "renderer/scene/scene.h"
#include "renderer/scene/sidecar.h"

namespace irad {

struct Autosave {
  std::filesystem::path scene;                          ///< as it can be opened from anywhere: absolute, or check:NAME
  int64_t time = 0;                                     ///< seconds since 1970, UTC
  Sidecar edits;                                        ///< all that was made of the scene
  std::optional<std::filesystem::path> sky, reference;  ///< pictures, absolute
  Settings settings;                                    ///< of the one side, or A of a comparison
  std::optional<Settings> other;                        ///< B
  View view = 0;
  Camera camera;
  bool operator==(const Autosave&) const = default;
};

/// Whole or not at all; WorkError where it cannot be written.
void writeAutosave(const std::filesystem::path& file, const Autosave& autosave);
/// InputError names file, object and value; also where another version of the program wrote it.
Autosave readAutosave(const std::filesystem::path& file);

/// "25 Nov 2026, 10:05", local time.
std::string timeInWords(int64_t time);
/// What it holds, a line each: lights, bookmarks, and the settings that are not `present`.
std::vector<std::string> contentInWords(const Autosave& autosave, const Settings& present);

/// The autosaves of all windows in a folder, a file each. A window that runs holds a lock of its file, so that no other
/// one takes it for a dead one's.
class Autosaves {
 public:
  /// `folder` is made when there is something to keep. Empty: nothing is ever kept or found.
  explicit Autosaves(std::filesystem::path folder);
  ~Autosaves();  ///< what is kept, and what was found and not removed, stays for the next start
  Autosaves(const Autosaves&) = delete;

  /// The newest of a window that has gone, once; none: there is none. One that cannot be read is an InputError, and is
  /// not looked at again.
  std::optional<Autosave> find();
  void removeFound();
  void leaveFound();  ///< for another start

  /// In place of what this window has kept; WorkError.
  void keep(const Autosave& autosave);
  void removeKept();
  bool keeps() const { return static_cast<bool>(own_); }

 private:
  /// A file, and the lock that says whose it is.
  struct Claim {
    std::filesystem::path file;
    int lock;
  };
  static std::optional<Claim> claim(const std::filesystem::path& file);
  static void release(std::optional<Claim>& claim, bool remove);
  std::filesystem::path folder_;
  std::optional<Claim> own_, found_;
  std::vector<std::filesystem::path> seen_;
};

}  // namespace irad
