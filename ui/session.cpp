#include "ui/session.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "gi/check/check.h"
#include "renderer/base/console.h"
#include "renderer/base/error.h"
#include "ui/widgets.h"

namespace irad {

void Session::say(Message::Kind kind, std::string text) {
  constexpr size_t most = 4;
  tell("irad: {}\n", text);
  std::erase_if(messages, [&](const Message& m) { return m.text == text; });
  messages.push_back({kind, std::move(text)});
  if (messages.size() > most) messages.erase(messages.begin());
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
  if (kept) return edits.again(scene);
  std::string nowhere;
  if (isCheckScene(scene.path))
    nowhere = "A check scene is no file: lights and bookmarks have nothing to be kept beside.";
  else if (isOurs(scene.path))
    nowhere = fmt::format("{} is built in. Copy it to a folder of your own to keep lights and bookmarks beside it.",
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
    note(fmt::format("Saved lights and bookmarks to {}", edits.file().string()));
  } catch (const Error& e) {
    error(fmt::format("{}\nLights and bookmarks stay in this window, unsaved.", e.what()));
  }
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

void Session::open(const std::filesystem::path& path) {
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
    edits.take(readSidecar(path));
    note(fmt::format("Lights and bookmarks are those of {}", path.filename().string()));
  } catch (const Error& e) {
    error(e.what());
  }
}

void Session::settingsSaved(const Settings& as) {
  for (Side* side : sides())
    if (sameSettings(side->edited, as)) side->saved = side->edited;
}

void Session::leave(Leaving what) {
  if (asking) return;  // one thing at a time
  if (!unsavedBefore(*this, what).any()) return leaveNow(what);
  showOpen = false;
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
    case Leaving::What::EndComparison:
      compare = false;
      break;
  }
}

/// Where a setting about how the scene is read asked to load it again, it goes back to what it was.
void Session::stay() {
  const Leaving stayed = *std::exchange(asking, std::nullopt);
  if (stayed.what == Leaving::What::OpenScene && pipeline && pipeline->scene().path == stayed.path)
    edited.scene = pipeline->settings().scene;
}

void Session::closeTopmost() {
  if (asking)
    stay();
  else if (showOpen)
    showOpen = false;
  else if (closePopup())
    return;
  else if (showHelp)
    showHelp = false;
  else if (work)
    work->cancel = true;
  else if (inspection.voxel)
    inspection.clear = true;
  else if (edits.selected >= 0)
    edits.selected = -1;
  else if (comparison)
    leave({Leaving::What::EndComparison});
}

void Session::act(Action action) {
  switch (action) {
    case Action::None:
      break;
    case Action::Help:
      showHelp = !showHelp;
      break;
    case Action::HideUi:
      hideUi = !hideUi;
      break;
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
    case Action::Flicker:
      if (comparison) {
        using Show = Comparison::Show;
        if (showsDifference()) viewDirty = true;  // the difference has a range of its own
        comparison->show = comparison->show == Show::A ? Show::B : Show::A;
      }
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
