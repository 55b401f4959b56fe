#include "ui/edit_state.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <iterator>
#include <set>
#include <utility>
#include <vector>

#include "renderer/scene/sky_image.h"
#include "ui/session.h"

namespace irad {
namespace {

std::string quoted(const std::string& name, const char* what) {
  return name.empty() ? fmt::format("a {}", what) : fmt::format("{} {}", what, name);
}

/// `side`: "", or "A: ".
void addSettings(std::vector<std::string>& words, const char* side, const Settings& from, const Settings& to) {
  const Setting* first = nullptr;
  size_t more = 0;
  for (const Setting& setting : settingTable()) {
    if (setting.get(from) == setting.get(to)) continue;
    if (first)
      ++more;
    else
      first = &setting;
  }
  if (!first) return;
  std::string text = fmt::format("{}{} {} to {}", side, first->name, first->text(from), first->text(to));
  if (more > 0) text += fmt::format(" and {} more", more);
  words.push_back(std::move(text));
}

/// What became of a list of named things: one more, one less, another one.
template <class T>
void addList(std::vector<std::string>& words, const char* one, const char* many, const std::vector<T>& from,
             const std::vector<T>& to, std::string (*change)(const T&, const T&)) {
  if (from == to) return;
  const auto [a, b] = std::mismatch(from.begin(), from.end(), to.begin(), to.end());
  if (to.size() == from.size() + 1 && std::equal(a, from.end(), b + 1, to.end()))
    words.push_back("add " + quoted(b->name, one));
  else if (to.size() + 1 == from.size() && std::equal(a + 1, from.end(), b, to.end()))
    words.push_back("remove " + quoted(a->name, one));
  else if (to.size() == from.size() && std::equal(a + 1, from.end(), b + 1, to.end()))
    words.push_back(fmt::format("{}: {}", quoted(b->name, one), change(*a, *b)));
  else
    words.emplace_back(many);
}

std::string lightChange(const Light& from, const Light& to) {
  std::vector<const char*> parts;
  const auto part = [&](bool differs, const char* name) {
    if (differs) parts.push_back(name);
  };
  part(from.name != to.name, "name");
  part(from.type != to.type, "type");
  part(from.on != to.on, to.on ? "on" : "off");
  part(from.position != to.position, "position");
  part(from.direction != to.direction, "direction");
  part(from.color != to.color, "color");
  part(from.intensity != to.intensity, "intensity");
  part(from.range != to.range, "range");
  part(from.innerCos != to.innerCos || from.outerCos != to.outerCos, "cone");
  part(from.angle != to.angle || from.radius != to.radius, "size");
  return fmt::format("{}", fmt::join(parts, ", "));
}

std::string bookmarkChange(const Camera& from, const Camera& to) {
  return from.name != to.name ? "name" : "place";
}

/// Each that is edited, edited otherwise, or the file's again.
void addMaterials(std::vector<std::string>& words, const std::vector<MaterialEdit>& from,
                  const std::vector<MaterialEdit>& to) {
  std::set<std::string> names;
  for (const auto& [one, other] : {std::pair(&from, &to), std::pair(&to, &from)})
    for (const MaterialEdit& edit : *one)
      if (std::ranges::find(*other, edit) == other->end()) names.insert(edit.material);
  if (names.empty()) return;
  std::string text = fmt::format("material {}", *names.begin());
  if (names.size() > 1) text += fmt::format(" and {} more", names.size() - 1);
  words.push_back(std::move(text));
}

/// Of hidden nodes their own names, without those above them.
void addHidden(std::vector<std::string>& words, const HiddenNodes& from, const HiddenNodes& to) {
  if (from == to) return;
  const auto own = [](const std::string& path) {
    size_t at = path.size();  // behind the last / that belongs to no name
    while (at > 0 && !(path[at - 1] == '/' && (at < 2 || path[at - 2] != '\\'))) --at;
    return path.substr(at);
  };
  if (to.empty()) return words.emplace_back("show all objects"), void();
  if (from.isolated != to.isolated)
    return words.push_back(to.isolated.empty() ? "end of isolation" : "isolate " + own(to.isolated));
  std::vector<std::string> hide, show;
  std::ranges::set_difference(to.paths, from.paths, std::back_inserter(hide));
  std::ranges::set_difference(from.paths, to.paths, std::back_inserter(show));
  const bool hides = !hide.empty();
  std::string text = fmt::format("{} {}", hides ? "hide" : "show", own(hides ? hide[0] : show[0]));
  if (hide.size() + show.size() > 1) text += fmt::format(" and {} more", hide.size() + show.size() - 1);
  words.push_back(std::move(text));
}

void addEdits(std::vector<std::string>& words, const Sidecar& from, const Sidecar& to) {
  const size_t before = words.size();
  addList(words, "light", "lights", from.lights.value_or(std::vector<Light>()),
          to.lights.value_or(std::vector<Light>()), lightChange);
  addMaterials(words, from.materials, to.materials);
  addHidden(words, from.hidden, to.hidden);
  addList(words, "bookmark", "bookmarks", from.bookmarks, to.bookmarks, bookmarkChange);
  if (from.region != to.region)
    words.emplace_back(to.region ? "scene.region by its box" : "scene.region without a box");
  if (words.size() == before && from != to) words.emplace_back("scene edits");
}

/// With lights that are the file's own, too, so that steps can be named.
Sidecar editsOf(const Session& session) {
  Sidecar edits = session.edits.content();
  edits.lights = session.edits.lights;
  edits.sceneSha256.clear();
  return edits;
}

std::shared_ptr<const ReferencePicture> referenceOf(const Session& session) {
  return session.reference && !session.reference->path.empty() ? session.reference : nullptr;
}

}  // namespace

bool EditState::onlyFlown(const EditState& other) const {
  return sameWork(other) && view == other.view && sceneCamera == other.sceneCamera && camera != other.camera;
}

EditState editStateOf(const Session& session) {
  const auto of = [](const Side& side) {
    SideEdits edits{side.edited, side.saved};
    edits.settings.view.facet = 0;
    return edits;
  };
  EditState state;
  state.a = of(session);
  if (session.comparison) {
    state.b = of(session.comparison->other);
    // The side that is not edited takes these from the other one (Builder::follow).
    state.b->settings.view = state.a.settings.view;
    if (session.comparison->sameSeed) state.b->settings.matrix.gpu.seed = state.a.settings.matrix.gpu.seed;
    if (session.comparison->editsB) std::swap(state.a, *state.b);
  }
  state.edits = editsOf(session);
  state.sky = session.load.sky;
  state.reference = referenceOf(session);
  state.view = session.view;
  state.camera = session.camera.camera();
  state.sceneCamera = session.sceneCamera;
  return state;
}

void restore(Session& session, const EditState& state) {
  const auto give = [](Side& side, const SideEdits& edits) {
    const uint32_t facet = side.edited.view.facet;
    side.edited = edits.settings;
    side.edited.view.facet = facet;
    side.saved = edits.saved;
  };
  give(session.sideA(), state.a);
  if (session.comparison && state.b) give(session.sideB(), *state.b);
  if (editsOf(session) != state.edits) session.edits.restore(state.edits);
  session.load.sky = state.sky;
  if (referenceOf(session) != state.reference) session.reference = state.reference;
  if (session.view != state.view) session.viewDirty = true;
  session.view = state.view;
  if (session.camera.camera() != state.camera) session.startAt(state.camera);
  session.sceneCamera = std::clamp(state.sceneCamera, 0, std::max(static_cast<int>(session.cameras().size()) - 1, 0));
}

std::string whatChanged(const EditState& from, const EditState& to) {
  std::vector<std::string> words;
  addSettings(words, to.b ? "A: " : "", from.a.settings, to.a.settings);
  if (from.b && to.b) addSettings(words, "B: ", from.b->settings, to.b->settings);
  addEdits(words, from.edits, to.edits);
  const auto addPicture = [&](const char* what, const auto& before, const auto& after) {
    if (before == after) return;
    const std::string name = (after ? after : before)->path.filename().string();
    words.push_back(fmt::format("{}{} {}", after ? "" : "without ", what, name));
  };
  addPicture("picture of the sky", from.sky, to.sky);
  addPicture("reference", from.reference, to.reference);
  if (from.view != to.view) words.push_back(fmt::format("view {}", viewInfo(to.view) ? viewInfo(to.view)->label : "?"));
  // A new bookmark is also the camera that is chosen.
  if (words.empty() && from.camera != to.camera)
    words.push_back(from.sceneCamera == to.sceneCamera ? "flight" : "camera " + cameraName(to.camera, to.sceneCamera));
  if (words.empty() && from.sceneCamera != to.sceneCamera) words.emplace_back("camera");
  return fmt::format("{}", fmt::join(words, ", "));
}

}  // namespace irad
