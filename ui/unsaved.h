// What the window would lose, and when it asks before it does (docs/conventions.md, "What is unsaved").
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "gi/settings.h"

namespace irad {

struct Session;
struct Side;

/// Something that may lose work.
struct Leaving {
  enum class What { Quit, OpenScene, OpenSidecar, EndComparison, Replay } what;
  std::filesystem::path path = {};      ///< of what is opened; Replay: of the scene
  std::filesystem::path manifest = {};  ///< that is replayed
};

/// What is lost by it.
struct Unsaved {
  bool edits = false;           ///< lights, materials, objects, bookmarks and region
  std::vector<Side*> settings;  ///< sides whose settings are nowhere else
  bool any() const { return edits || !settings.empty(); }
};
Unsaved unsavedBefore(Session& session, const Leaving& leaving);

/// All but what picking a facet sets.
bool sameSettings(Settings a, Settings b);
/// Those in which they are not, in their table's order.
std::vector<const Setting*> differingSettings(Settings a, Settings b);

}  // namespace irad
