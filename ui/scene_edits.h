// What the window's user has made of a scene beside its file: lights, edits of materials, hidden nodes, camera
// bookmarks, the box that has voxels. Panels and handles edit them, the builder makes a picture of them, the sidecar
// keeps them.
#pragma once

#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "renderer/scene/sidecar.h"

namespace irad {

/// "lamp", or "lamp 2" where that is taken, and so on.
std::string freeName(const std::string& wanted, const std::vector<std::string>& taken);

class SceneEdits {
 public:
  std::vector<Light> lights;
  std::vector<MaterialEdit> materials;  ///< sorted by name; none that changes nothing
  HiddenNodes hidden;
  std::vector<Camera> bookmarks;
  std::optional<RegionBox> region;  ///< Scene::region
  int selected = -1;                ///< the light that has handles and whose fields are shown; -1: none
  bool showHandles = true;          ///< in the picture; of other scenes too

  /// Begins with what the scene came with. `file`: where save() writes; empty where `reason` says why nowhere.
  void begin(const Scene& scene, std::filesystem::path file, std::string reason);
  /// The same file, loaded again: edits of its lights and cameras stay.
  void again(const Scene& scene);

  Light* light();  ///< the selected one; null: none
  /// Appends under a free name and selects it.
  void add(Light light);
  void remove();  ///< the selected one

  /// The edit of a material; one that changes nothing where there is none.
  MaterialEdit material(const std::string& name) const;
  /// Puts it in place of the edit of the same material.
  void setMaterial(MaterialEdit edit);

  /// A node of the scene is hidden, or no longer by its own name.
  void hide(std::span<const SceneNode> nodes, uint32_t node, bool hide);
  /// Nothing else is shown, whatever of it was hidden before.
  void isolate(std::span<const SceneNode> nodes, uint32_t node);
  void showAll() { hidden = {}; }

  /// A copy of `camera` under a free name: its index.
  size_t addBookmark(const Camera& camera, const std::string& name);
  /// Nothing happens where the name is empty or taken.
  void rename(size_t bookmark, const std::string& name);

  bool modified() const;  ///< changed since it was loaded or saved
  /// The file holds something.
  bool kept() const {
    return saved_.lights || !saved_.materials.empty() || !saved_.hidden.empty() || !saved_.bookmarks.empty() ||
           saved_.region;
  }
  const std::filesystem::path& file() const { return file_; }
  const std::string& whyNowhere() const { return reason_; }
  /// Writes the sidecar; WorkError where that fails or there is nowhere to write: the edits stay as they are.
  void save();
  /// The same in a place of the user's choice, which is save()'s from then on.
  void saveAs(const std::filesystem::path& file);
  /// All that a user has made of the scene, as it would be saved: what undo goes back to (ui/edit_state.h), what is
  /// kept against a crash (ui/autosave.h). Lights that are the file's own are not in it: the file may yet change.
  Sidecar content() const;
  /// That in place of these; nothing is saved. The chosen light stays chosen where there still is one of that number;
  /// one that comes back is chosen.
  void restore(Sidecar content);
  /// The same of another sidecar: no light is chosen.
  void take(Sidecar sidecar);
  /// Whether revert() would change anything: away from what was saved or, from there, from the scene file's own lights.
  bool canRevert() const { return modified() || !lightsAreTheFiles(); }
  bool lightsAreTheFiles() const { return lights == fileLights_; }
  /// To what was saved; where that is what there is, to the scene file's own lights. Bookmarks that were saved stay.
  void revert();

 private:
  std::vector<std::string> cameraNames() const;  ///< of the scene's and the bookmarks
  std::vector<Light> fileLights_;
  std::vector<std::string> fileCameras_;  ///< names
  std::string sceneSha256_;
  Sidecar saved_;
  std::filesystem::path file_;
  std::string reason_;
};

}  // namespace irad
