#include "ui/scene_edits.h"

#include <fmt/format.h>

#include <algorithm>

#include "renderer/base/error.h"
#include "renderer/base/output_file.h"
#include "renderer/scene/material_edits.h"

namespace irad {

std::string freeName(const std::string& wanted, const std::vector<std::string>& taken) {
  std::string name = wanted;
  for (int n = 2; std::find(taken.begin(), taken.end(), name) != taken.end(); ++n)
    name = fmt::format("{} {}", wanted, n);
  return name;
}

void SceneEdits::begin(const Scene& scene, std::filesystem::path file, std::string reason) {
  const bool handles = showHandles;
  *this = {};
  showHandles = handles;
  file_ = std::move(file);
  reason_ = std::move(reason);
  lights = scene.lights;
  materials = scene.materialEdits;
  bookmarks = scene.bookmarks;
  again(scene);
  saved_ = current();
}

void SceneEdits::again(const Scene& scene) {
  fileLights_ = scene.fileLights;
  sceneSha256_ = scene.sha256;
  fileCameras_.clear();
  for (const Camera& camera : scene.cameras) fileCameras_.push_back(camera.name);
}

Light* SceneEdits::light() {
  return selected >= 0 && static_cast<size_t>(selected) < lights.size() ? &lights[static_cast<size_t>(selected)]
                                                                        : nullptr;
}

void SceneEdits::add(Light light) {
  std::vector<std::string> names;
  for (const Light& other : lights) names.push_back(other.name);
  light.name = freeName(light.name, names);
  lights.push_back(std::move(light));
  selected = static_cast<int>(lights.size()) - 1;
}

void SceneEdits::remove() {
  const Light* chosen = light();
  if (chosen == nullptr) return;
  removed_.emplace_back(selected, *chosen);
  lights.erase(lights.begin() + selected);
  selected = std::min(selected, static_cast<int>(lights.size()) - 1);
}

const Light* SceneEdits::removed() const {
  return removed_.empty() ? nullptr : &removed_.back().second;
}

void SceneEdits::undoRemoval() {
  if (removed_.empty()) return;
  const size_t at = std::min(removed_.back().first, lights.size());
  lights.insert(lights.begin() + static_cast<ptrdiff_t>(at), std::move(removed_.back().second));
  removed_.pop_back();
  selected = static_cast<int>(at);
}

MaterialEdit SceneEdits::material(const std::string& name) const {
  const auto at = std::ranges::lower_bound(materials, name, {}, &MaterialEdit::material);
  return at != materials.end() && at->material == name ? *at : MaterialEdit{.material = name};
}

void SceneEdits::setMaterial(MaterialEdit edit) {
  const auto at = std::ranges::lower_bound(materials, edit.material, {}, &MaterialEdit::material);
  const bool there = at != materials.end() && at->material == edit.material;
  if (isEmpty(edit)) {
    if (there) materials.erase(at);
  } else if (there) {
    *at = std::move(edit);
  } else {
    materials.insert(at, std::move(edit));
  }
}

size_t SceneEdits::addBookmark(const Camera& camera, const std::string& name) {
  const std::string free = freeName(name, cameraNames());
  bookmarks.push_back(camera);
  bookmarks.back().name = free;
  return bookmarks.size() - 1;
}

std::vector<std::string> SceneEdits::cameraNames() const {
  std::vector<std::string> names = fileCameras_;
  for (const Camera& camera : bookmarks) names.push_back(camera.name);
  return names;
}

void SceneEdits::rename(size_t bookmark, const std::string& name) {
  if (!name.empty() && freeName(name, cameraNames()) == name) bookmarks.at(bookmark).name = name;
}

/// Lights that are the file's own are not saved: the file may yet change.
Sidecar SceneEdits::current() const {
  Sidecar sidecar;
  if (lights != fileLights_) sidecar.lights = lights;
  sidecar.materials = materials;
  sidecar.bookmarks = bookmarks;
  sidecar.sceneSha256 = sceneSha256_;
  return sidecar;
}

bool SceneEdits::modified() const {
  const bool changed = lights == fileLights_ ? saved_.lights.has_value() : saved_.lights != lights;
  return changed || materials != saved_.materials || bookmarks != saved_.bookmarks;
}

void SceneEdits::save() {
  if (file_.empty()) throw WorkError(reason_);
  Sidecar sidecar = current();
  writeSidecar(file_, sidecar);
  saved_ = std::move(sidecar);
}

void SceneEdits::saveAs(const std::filesystem::path& file) {
  Sidecar sidecar = current();
  if (file.has_parent_path()) makeFolder(file.parent_path());
  writeSidecar(file, sidecar);
  saved_ = std::move(sidecar);
  file_ = file;
}

void SceneEdits::take(Sidecar sidecar) {
  lights = std::move(sidecar.lights).value_or(fileLights_);
  materials = std::move(sidecar.materials);
  bookmarks = std::move(sidecar.bookmarks);
  selected = -1;
  removed_.clear();
}

void SceneEdits::revert() {
  lights = saved_.lights.value_or(fileLights_);
  materials = saved_.materials;
  bookmarks = saved_.bookmarks;
  selected = std::min(selected, static_cast<int>(lights.size()) - 1);
  removed_.clear();
}

}  // namespace irad
