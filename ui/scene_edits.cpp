#include "ui/scene_edits.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "renderer/base/error.h"
#include "renderer/base/output_file.h"
#include "renderer/scene/material_edits.h"
#include "renderer/scene/nodes.h"

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
  hidden = scene.hidden;
  bookmarks = scene.bookmarks;
  region = scene.region;
  again(scene);
  saved_ = content();
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
  if (light() == nullptr) return;
  lights.erase(lights.begin() + selected);
  selected = std::min(selected, static_cast<int>(lights.size()) - 1);
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

void SceneEdits::hide(std::span<const SceneNode> nodes, uint32_t node, bool hide) {
  const std::string path = nodePath(nodes, node);
  const auto at = std::ranges::lower_bound(hidden.paths, path);
  const bool there = at != hidden.paths.end() && *at == path;
  if (hide && !there) hidden.paths.insert(at, path);
  if (!hide && there) hidden.paths.erase(at);
}

void SceneEdits::isolate(std::span<const SceneNode> nodes, uint32_t node) {
  for (uint32_t at = node; at != SceneNode::kNoParent; at = nodes[at].parent) hide(nodes, at, false);
  hidden.isolated = nodePath(nodes, node);
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

Sidecar SceneEdits::content() const {
  Sidecar sidecar;
  if (lights != fileLights_) sidecar.lights = lights;
  sidecar.materials = materials;
  sidecar.hidden = hidden;
  sidecar.bookmarks = bookmarks;
  sidecar.region = region;
  sidecar.sceneSha256 = sceneSha256_;
  return sidecar;
}

bool SceneEdits::modified() const {
  const bool changed = lights == fileLights_ ? saved_.lights.has_value() : saved_.lights != lights;
  return changed || materials != saved_.materials || hidden != saved_.hidden || bookmarks != saved_.bookmarks ||
         region != saved_.region;
}

void SceneEdits::save() {
  if (file_.empty()) throw WorkError(reason_);
  Sidecar sidecar = content();
  writeSidecar(file_, sidecar);
  saved_ = std::move(sidecar);
}

void SceneEdits::saveAs(const std::filesystem::path& file) {
  Sidecar sidecar = content();
  if (file.has_parent_path()) makeFolder(file.parent_path());
  writeSidecar(file, sidecar);
  saved_ = std::move(sidecar);
  file_ = file;
}

void SceneEdits::restore(Sidecar content) {
  const std::vector<Light> before = std::exchange(lights, content.lights ? std::move(*content.lights) : fileLights_);
  materials = std::move(content.materials);
  hidden = std::move(content.hidden);
  bookmarks = std::move(content.bookmarks);
  region = content.region;
  const auto count = static_cast<int>(lights.size());
  if (lights.size() == before.size() + 1)
    selected = static_cast<int>(std::mismatch(before.begin(), before.end(), lights.begin()).first - before.begin());
  selected = std::min(selected, count - 1);
}

void SceneEdits::take(Sidecar sidecar) {
  restore(std::move(sidecar));
  selected = -1;
}

void SceneEdits::revert() {
  Sidecar to = saved_;
  if (!modified()) to.lights.reset();
  restore(std::move(to));
}

}  // namespace irad
