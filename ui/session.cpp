#include "ui/session.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <utility>

#include "gi/check/check.h"
#include "gi/stage_keys.h"
#include "renderer/base/console.h"
#include "renderer/base/error.h"
#include "renderer/scene/material_edits.h"
#include "renderer/scene/nodes.h"
#include "ui/widgets.h"

namespace irad {

void Session::say(Message::Kind kind, std::string text, std::filesystem::path folder) {
  constexpr size_t most = 4, mostErrors = 50;
  tell("irad: {}\n", text);
  std::erase_if(messages, [&](const Message& m) { return m.text == text; });
  messages.push_back({kind, std::move(text), std::move(folder)});
  if (messages.size() <= most) return;
  // The oldest note goes: errors are to be seen.
  const auto note = std::ranges::find(messages, Message::Kind::Note, &Message::kind);
  if (note != messages.end())
    messages.erase(note);
  else if (messages.size() > mostErrors)
    messages.erase(messages.begin());
}

std::optional<std::chrono::steady_clock::time_point> Session::nextMessageEnds() const {
  std::optional<std::chrono::steady_clock::time_point> first;
  for (const Message& m : messages)
    if (m.kind == Message::Kind::Note && m.shown && (!first || *m.shown + Message::kNoteStays < *first))
      first = *m.shown + Message::kNoteStays;
  return first;
}

double Session::exposure() const {
  const double fixed = std::exp2(double{edited.camera.exposureEv});
  const ViewInfo* info = viewInfo(view);
  if (!edited.camera.autoExposure || !range || rangeView != view || info == nullptr || !info->toneMapped())
    return fixed;
  return fixed * double{autoExposure(*range)} * (info->kind == VIEW_KIND_IRRADIANCE ? double{IRAD_PI} : 1);
}

bool Session::isOurs(const std::filesystem::path& scene) const {
  const auto isBuiltIn = [&](const std::filesystem::path& folder) {
    std::error_code ignored;
    return std::filesystem::equivalent(std::filesystem::absolute(scene).parent_path(), folder, ignored);
  };
  return isCheckScene(scene) || std::any_of(builtIn.begin(), builtIn.end(), isBuiltIn);
}

void Session::expose(const std::filesystem::path& scene) {
  if (!exposes || edited.camera.autoExposure != saved.camera.autoExposure) return;
  edited.camera.autoExposure = saved.camera.autoExposure = !isOurs(scene);
}

void Session::beginEdits(bool kept) {
  const Scene& scene = pipeline->scene();
  if (object && *object >= scene.nodes.size()) object.reset();
  if (kept) return edits.again(scene);
  material.reset();
  object.reset();
  materialEdit.reset();
  std::string nowhere;
  if (isCheckScene(scene.path))
    nowhere =
        "A check scene is no file: lights, materials, objects, bookmarks and region have nothing to be kept beside.";
  else if (isOurs(scene.path))
    nowhere = fmt::format(
        "{} is built in. Copy it to a folder of your own to keep lights, materials, objects, bookmarks and region "
        "beside it.",
        scene.path.filename().string());
  else if (!load.sidecar)
    nowhere =
        fmt::format("{} was opened without its sidecar, which saving would replace.", scene.path.filename().string());
  edits.begin(scene, nowhere.empty() ? sidecarPath(scene.path) : std::filesystem::path(), nowhere);
  if (!scene.sidecar.empty()) tell("irad: {}\n", sidecarNote(scene));
}

std::vector<Camera> Session::cameras() const {
  if (!pipeline) return {};
  std::vector<Camera> all = pipeline->scene().cameras;
  all.insert(all.end(), edits.bookmarks.begin(), edits.bookmarks.end());
  return all;
}

void Session::saveEdits() {
  try {
    edits.save();
    note(fmt::format("Saved lights, materials, objects, bookmarks and region to {}", edits.file().string()));
  } catch (const Error& e) {
    error(fmt::format("{}\nLights, materials, objects, bookmarks and region stay in this window, unsaved.", e.what()));
  }
}

std::filesystem::path lastingPath(const std::filesystem::path& scene) {
  return isCheckScene(scene) ? scene : std::filesystem::absolute(scene).lexically_normal();
}

std::string cameraName(const Camera& camera, int index) {
  return camera.name.empty() ? fmt::format("camera {}", index + 1) : camera.name;
}

void Session::startAt(const Camera& from) {
  const Scene& scene = pipeline->scene();
  camera.start(from, glm::distance(scene.boundsMin, scene.boundsMax));
  viewDirty = true;
}

void Session::useSceneCamera(int index) {
  const std::vector<Camera> all = cameras();
  if (all.empty()) return;
  sceneCamera = std::clamp(index, 0, static_cast<int>(all.size()) - 1);
  startAt(all[static_cast<size_t>(sceneCamera)]);
}

Session::Sphere Session::sceneSphere() const {
  const Scene& scene = pipeline->scene();
  const double radius = 0.5 * glm::distance(glm::dvec3(scene.boundsMin), glm::dvec3(scene.boundsMax));
  return {scene.origin + 0.5 * glm::dvec3(scene.boundsMin + scene.boundsMax), std::max(radius, 1e-6)};
}

std::optional<Session::Sphere> Session::chosenSphere() const {
  const Sphere all = sceneSphere();
  const Scene& scene = pipeline->scene();
  const bool light = edits.selected >= 0 && static_cast<size_t>(edits.selected) < edits.lights.size();
  if (object && *object < scene.nodes.size() && !(light && lightLast_)) {
    const SceneNode& node = scene.nodes[*object];
    const uint32_t total = (scene.whole ? *scene.whole : scene).triangleCount();
    if (node.triangles > 0 && node.triangles < total)
      return Sphere{0.5 * (node.boundsMin + node.boundsMax),
                    std::max(0.5 * glm::distance(node.boundsMin, node.boundsMax), 1e-6 * all.radius)};
  }
  if (const InspectedFacet* facet = inspection.facet())
    return Sphere{facet->position, std::max(6 * inspection.edge(), 1e-6 * all.radius)};
  if (light) return Sphere{edits.lights[static_cast<size_t>(edits.selected)].position, 0.1 * all.radius};
  if (!material) return std::nullopt;
  glm::dvec3 low(std::numeric_limits<double>::max()), high = -low;
  for (const Draw& draw : scene.draws)
    for (uint32_t i = draw.firstIndex; draw.material == *material && i < draw.firstIndex + draw.indexCount; ++i) {
      const glm::dvec3 at(scene.positions[scene.indices[i]]);
      low = glm::min(low, at);
      high = glm::max(high, at);
    }
  if (low.x > high.x) return std::nullopt;
  return Sphere{scene.origin + 0.5 * (low + high), std::max(0.5 * glm::distance(low, high), 1e-6 * all.radius)};
}

void Session::openFailed(const std::string& text) {
  if (!std::exchange(openedInDialog_, false)) return error(text);
  tell("irad: {}\n", text);
  openError = text;
  showOpen = true;
}

void Session::open(const std::filesystem::path& path, bool fromDialog) {
  openedInDialog_ = fromDialog;
  const std::string extension = path.extension().string();
  // Those of 8 bits too, so that it is said what they lack.
  constexpr std::array kPictures{".exr", ".hdr", ".pfm", ".png", ".jpg", ".jpeg"};
  if (std::find(kPictures.begin(), kPictures.end(), extension) != kPictures.end())
    openPicture = path;
  else
    leave(
        {path.filename().string().ends_with(kSidecarExtension) ? Leaving::What::OpenSidecar : Leaving::What::OpenScene,
         path});
}

void Session::openSidecar(const std::filesystem::path& path) {
  try {
    Sidecar sidecar = readSidecar(path);
    const std::vector<SceneNode>& nodes = pipeline->scene().nodes;
    sidecar.hidden = hiddenPaths(nodes, sidecar.hidden);
    edits.take(std::move(sidecar));
    history.call(fmt::format("lights, materials, objects, bookmarks and region of {}", path.filename().string()));
    for (const std::string& unknown : unknownMaterials(pipeline->scene(), edits.materials))
      note(fmt::format("{}: {}", path.filename().string(), unknown));
    for (const std::string& unknown : unknownNodes(nodes, edits.hidden))
      note(fmt::format("{}: {}", path.filename().string(), unknown));
    note(fmt::format("Lights, materials, objects, bookmarks and region are those of {}", path.filename().string()));
  } catch (const Error& e) {
    openFailed(e.what());
  }
}

void Session::settingsSaved(const Settings& as) {
  for (Side* side : sides())
    if (sameSettings(side->edited, as)) side->saved = side->edited;
}

void Session::leave(Leaving what) {
  if (asking) return;  // one thing at a time
  if (!unsavedBefore(*this, what).any()) return leaveNow(what);
  showOpen = captures.shown = false;
  asking = std::move(what);
}

void Session::leaveNow(const Leaving& what) {
  const Leaving going = what;
  asking.reset();
  switch (going.what) {
    case Leaving::What::Quit:
      quit = true;
      if (work) work->cancel = true;
      break;
    case Leaving::What::OpenScene:
      openScene = going.path;
      break;
    case Leaving::What::OpenSidecar:
      openSidecar(going.path);
      break;
    case Leaving::What::Replay:
      captures.replay = going.manifest;
      captures.shown = false;
      break;
    case Leaving::What::EndComparison:
      compare = false;
      break;
  }
}

/// Where a setting about how the scene is read asked to load it again, it goes back to what it was.
void Session::stay() {
  const Leaving stayed = *std::exchange(asking, std::nullopt);
  if (stayed.what != Leaving::What::OpenScene || !pipeline || pipeline->scene().path != stayed.path) return;
  edited.scene = pipeline->settings().scene;
  returned = true;
}

void Session::seeEdits(bool held) {
  if (!pipeline) return;
  if (std::exchange(objectSeen_, object) != object) lightLast_ = false;
  if (std::exchange(lightSeen_, edits.selected) != edits.selected) lightLast_ = true;
  if (std::exchange(returned, false))
    history.seeReturned(editStateOf(*this));
  else
    history.see(editStateOf(*this), held);
}

void Session::goToStep(size_t step) {
  seeEdits(/*held=*/false);
  if (step >= history.steps().size()) return;
  const Settings before = edited;
  const HiddenNodes hiddenBefore = edits.hidden;
  restore(*this, history.go(step));
  const bool other = firstDifference(before, edited) != Redo::Nothing || hiddenBefore != edits.hidden;
  if (work && work->ofSettings && other) work->cancel = true;
}

void Session::closeTopmost() {
  if (asking)
    stay();
  else if (found)
    answer = Offer::Later;
  else if (closePopup(/*dialogs=*/showOpen || captures.shown ? 1 : 0))
    return;
  else if (showOpen || captures.shown)
    showOpen = captures.shown = false;
  else if (showHelp || showGlossary)
    showHelp = showGlossary = false;
  else if (work)
    work->cancel = true;
  else if (inspection.voxel)
    inspection.clear = true;
  else if (object)
    object.reset();
  else if (edits.selected >= 0)
    edits.selected = -1;
  else if (comparison)
    leave({Leaving::What::EndComparison});
}

void Session::showPanel(const char* title, const char* column) {
  hideUi = fillWindow = false;
  preferences.folded.erase(title);
  preferences.folded.erase(column);
}

void Session::act(Action action) {
  switch (action) {
    case Action::None:
      break;
    case Action::Help:
      showHelp = !showHelp;
      break;
    case Action::FindSetting:
      showPanel("Settings", kLeftColumn);
      findSetting = true;
      break;
    case Action::HideUi:
      hideUi = !hideUi;
      break;
    case Action::FillWindow:
      fillWindow = !fillWindow;
      hideUi = false;
      break;
    case Action::LargerUi:
    case Action::SmallerUi: {
      const float step = action == Action::LargerUi ? 0.25f : -0.25f;
      preferences.scale = std::clamp(scale + step, Preferences::kSmallest, Preferences::kLargest);
      break;
    }
    case Action::ReloadShaders:
      reloadShaders = true;
      break;
    case Action::Capture:
      capture = true;
      break;
    case Action::CaptureAll:
      captureAll = true;
      break;
    case Action::Pause:
      paused = !paused;
      break;
    case Action::NextCamera:
      if (pipeline) useSceneCamera((sceneCamera + 1) % static_cast<int>(cameras().size()));
      break;
    case Action::FrameSelected:
    case Action::FrameAll:
      if (pipeline && targets.size.y > 0) {
        const std::optional<Sphere> chosen = action == Action::FrameSelected ? chosenSphere() : std::nullopt;
        const Sphere sphere = chosen.value_or(sceneSphere());
        camera.frame(sphere.centre, sphere.radius,
                     static_cast<float>(targets.size.x) / static_cast<float>(targets.size.y));
        viewDirty = true;
      }
      break;
    case Action::HideObject:
    case Action::IsolateObject:
      if (pipeline && object && *object < pipeline->scene().nodes.size()) {
        const std::vector<SceneNode>& nodes = pipeline->scene().nodes;
        if (action == Action::HideObject)
          edits.hide(nodes, *object, !std::ranges::binary_search(edits.hidden.paths, nodePath(nodes, *object)));
        else
          edits.isolate(nodes, *object);
      }
      break;
    case Action::ShowAllObjects:
      edits.showAll();
      break;
    case Action::WholePicture:
      pointing.zoom = {};
      break;
    case Action::Flicker:
      if (comparison) {
        using Show = Comparison::Show;
        if (showsDifference()) viewDirty = true;  // the difference has a range of its own
        comparison->show = comparison->show == Show::A ? Show::B : Show::A;
      }
      break;
    case Action::Undo:
      seeEdits(/*held=*/false);  // a flight may not have been seen yet
      if (history.canUndo()) goToStep(history.at() - 1);
      break;
    case Action::Redo:
      seeEdits(/*held=*/false);
      if (history.canRedo()) goToStep(history.at() + 1);
      break;
    case Action::Open:
      showOpen = true;
      break;
    case Action::Close:
      closeTopmost();
      break;
    case Action::Quit:
      leave({Leaving::What::Quit});
      break;
  }
}

void Side::woke() {
  solves.clear();
  sweepsSinceWake = 0;
}

void Session::swapSides() {
  std::swap(static_cast<Side&>(*this), comparison->other);
  comparison->editsB = !comparison->editsB;
}

std::vector<Side*> Session::sides() {
  std::vector<Side*> all{this};
  if (comparison) all.push_back(&comparison->other);
  return all;
}

std::string stagesFrom(Redo first, const char* arrow) {
  std::string text;
  for (auto stage = static_cast<uint32_t>(first); stage < static_cast<uint32_t>(Redo::Nothing); ++stage) {
    if (!text.empty()) text += std::string(" ") + arrow + " ";
    text += nameOf(static_cast<Redo>(stage));
  }
  return text;
}

}  // namespace irad
