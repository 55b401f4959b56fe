// What the window's user has made of a scene beside its file: lights, edits of materials, camera bookmarks. Panels and
// handles edit them, the builder hands lights and materials to the pipeline, the sidecar keeps them.
#pragma once

#include <filesystem>
#include <string>
#include <utility>
#include <vector>

#include "renderer/scene/sidecar.h"

namespace irad {

/// "lamp", or "lamp 2" where that is taken, and so on.
std::string freeName(const std::string& wanted, const std::vector<std::string>& taken);

class SceneEdits {
 public:
  std::vector<Light> lights;
  std::vector<MaterialEdit> materials;  ///< sorted by name; none that changes nothing
  std::vector<Camera> bookmarks;
  int selected = -1;        ///< the light that has handles and whose fields are shown; -1: none
  bool showHandles = true;  ///< in the picture; of other scenes too

  /// Begins with what the scene came with. `file`: where save() writes; empty where `reason` says why nowhere.
  void begin(const Scene& scene, std::filesystem::path file, std::string reason);
  /// The same file, loaded again: edits of its lights and cameras stay.
  void again(const Scene& scene);

  Light* light();  ///< the selected one; null: none
  /// Appends under a free name and selects it.
  void add(Light light);
  void remove();  ///< the selected one
  /// The light that undoRemoval() would bring back; null: none.
  const Light* removed() const;
  void undoRemoval();

  /// The edit of a material; one that changes nothing where there is none.
  MaterialEdit material(const std::string& name) const;
  /// Puts it in place of the edit of the same material.
  void setMaterial(MaterialEdit edit);

  /// A copy of `camera` under a free name: its index.
  size_t addBookmark(const Camera& camera, const std::string& name);
  /// Nothing happens where the name is empty or taken.
  void rename(size_t bookmark, const std::string& name);

  bool modified() const;  ///< changed since it was loaded or saved
  /// The file holds something.
  bool kept() const { return saved_.lights || !saved_.materials.empty() || !saved_.bookmarks.empty(); }
  const std::filesystem::path& file() const { return file_; }
  const std::string& whyNowhere() const { return reason_; }
  /// Writes the sidecar; WorkError where that fails or there is nowhere to write: the edits stay as they are.
  void save();
  /// The same in a place of the user's choice, which is save()'s from then on.
  void saveAs(const std::filesystem::path& file);
  /// Lights, materials and bookmarks of another sidecar in place of these; nothing is saved.
  void take(Sidecar sidecar);
  void revert();  ///< to what was saved

 private:
  Sidecar current() const;
  std::vector<std::string> cameraNames() const;  ///< of the scene's and the bookmarks
  std::vector<Light> fileLights_;
  std::vector<std::string> fileCameras_;  ///< names
  std::string sceneSha256_;
  Sidecar saved_;
  std::filesystem::path file_;
  std::string reason_;
  std::vector<std::pair<size_t, Light>> removed_;  ///< and where they were in the list, the last one at the end
};

}  // namespace irad
