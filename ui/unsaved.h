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
  enum class What { Quit, OpenScene, OpenSidecar, EndComparison } what;
  std::filesystem::path path = {};  ///< of what is opened
};

/// What is lost by it.
struct Unsaved {
  bool edits = false;           ///< lights, materials and bookmarks
  std::vector<Side*> settings;  ///< sides whose settings are nowhere else
  bool any() const { return edits || !settings.empty(); }
};
Unsaved unsavedBefore(Session& session, const Leaving& leaving);

/// All but what picking a facet sets.
bool sameSettings(Settings a, Settings b);

}  // namespace irad
