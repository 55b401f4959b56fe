// What a user edits in the window, as one value: what undo goes back to, and what is kept against a crash. Whatever
// else becomes editable joins here: a part of the scene in Sidecar (renderer/scene/sidecar.h), which SceneEdits fills
// and takes back, and a name for its steps in whatChanged(); anything else as a member.
#pragma once

#include <memory>
#include <optional>
#include <string>

#include "gi/settings.h"
#include "gi/views/views.h"
#include "renderer/scene/scene.h"
#include "renderer/scene/sidecar.h"

namespace irad {

struct ReferencePicture;
struct Session;

/// The settings of a side. Which facet is picked is no edit: it is 0 here.
struct SideEdits {
  Settings settings;
  Settings saved;  ///< Side::saved: it comes back with the settings, and is no edit by itself
  bool operator==(const SideEdits& other) const { return settings == other.settings; }
};

struct EditState {
  SideEdits a;                                        ///< of the one side there is, or A of a comparison
  std::optional<SideEdits> b;                         ///< of a comparison
  Sidecar edits;                                      ///< of the scene: always with lights, and without its SHA-256
  std::shared_ptr<const SkyImage> sky;                ///< for sky.source = image
  std::shared_ptr<const ReferencePicture> reference;  ///< of a file: what is traced meanwhile is no edit
  View view = 0;
  Camera camera;
  int sceneCamera = 0;  ///< Session::sceneCamera

  bool operator==(const EditState&) const = default;
  /// They differ at most in where one looks from, and at which view.
  bool sameWork(const EditState& other) const {
    return a == other.a && b == other.b && edits == other.edits && sky == other.sky && reference == other.reference;
  }
  /// Only the camera differs, and it was flown there.
  bool onlyFlown(const EditState& other) const;
};

/// As of now. There must be a scene.
EditState editStateOf(const Session& session);
/// Brings it back. The loop redoes what that calls for, as for any edit.
void restore(Session& session, const EditState& state);
/// The step from one to the other in a few words: "voxel.resolution 64 to 96", "add light lamp", "flight". Empty where
/// they are equal.
std::string whatChanged(const EditState& from, const EditState& to);

}  // namespace irad
