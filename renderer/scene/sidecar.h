// X.glb.irad.json, the sidecar of X.glb: what the viewer's user has made of a scene without touching its file: lights,
// edits of materials, hidden nodes, camera bookmarks, the part that has voxels.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "renderer/scene/scene.h"

namespace irad {

/// Its member "format": raised when older programs would misread it.
constexpr uint32_t kSidecarFormat = 1;

struct Sidecar {
  std::optional<std::vector<Light>> lights;  ///< in place of all of the scene's; absent: the scene's own
  std::vector<MaterialEdit> materials;       ///< each of another material, sorted by name
  HiddenNodes hidden;
  std::vector<Camera> bookmarks;  ///< each has a name of its own
  std::optional<RegionBox> region;
  std::string sceneSha256;  ///< of the scene file when this was saved; empty: not known
  bool operator==(const Sidecar&) const = default;
};

/// The ending of sidecars' names.
constexpr const char* kSidecarExtension = ".irad.json";

/// As its file holds it.
std::string sidecarToJson(const Sidecar& sidecar);
/// UsageError "LABEL: ..." names object and value; also where a newer program wrote it.
Sidecar sidecarFromJson(std::string_view json, const std::string& label);

/// Beside the scene file.
std::filesystem::path sidecarPath(const std::filesystem::path& scene);
/// InputError names file, object and value; also where a newer program wrote it.
Sidecar readSidecar(const std::filesystem::path& path);
/// Whole or not at all; WorkError where it cannot be written.
void writeSidecar(const std::filesystem::path& path, const Sidecar& sidecar);
/// Gives the scene what the sidecar beside it holds, if there is one: what is to be hidden it then has in
/// Scene::hidden, and all of its nodes are still there. A scene file that has changed since is a warning.
void takeSidecar(Scene& scene);
/// "lights and cameras of X.glb.irad.json": what it gave a scene.
std::string sidecarNote(const Scene& scene);

}  // namespace irad
