// What is kept from one window to the next, and brought back: the layout, unsaved work, what a capture was made of.
#include <fmt/format.h>

#include <utility>

#include "renderer/base/error.h"
#include "renderer/scene/material_edits.h"
#include "renderer/scene/nodes.h"
#include "renderer/scene/sky_image.h"
#include "ui/comparison.h"
#include "ui/imgui.h"
#include "ui/window_impl.h"

namespace irad {

void Window::readPreferences() {
  if (options_.preferences.empty()) return;
  try {
    session_.preferences = irad::readPreferences(options_.preferences);
  } catch (const Error& error) {
    session_.error(fmt::format("The layout is that of a first start. {}", error.what()));
  }
  saved_ = session_.preferences;
}

/// Once per change, and not while the mouse is making it. A folder that cannot be written into is reported once.
void Window::savePreferences() {
  if (options_.preferences.empty() || session_.preferences == saved_ || ImGui::IsAnyItemActive()) return;
  saved_ = session_.preferences;
  writer_.add([this, preferences = saved_]() -> BackgroundWorker::Result {
    try {
      writePreferences(options_.preferences, preferences);
      return [] {};
    } catch (const Error& error) {
      return [this, text = std::string(error.what())] {
        if (!std::exchange(toldUnsaved_, true)) session_.error(fmt::format("The layout is not remembered. {}", text));
      };
    }
  });
}

void Window::offerFound() {
  keeper_.offer(session_);
  framesLeft_ = kFramesPerEvent;
}

void Window::answerOffer(Session::Offer answer) {
  if (!session_.found) return;
  const Autosave found = *std::exchange(session_.found, std::nullopt);
  if (answer == Session::Offer::Discard) {
    keeper_.removeFound();
    return offerFound();
  }
  // It is in a file at every moment.
  if (answer == Session::Offer::Take && take(found) && keeper_.keepNow(session_)) keeper_.removeFound();
  keeper_.leaveFound();
}

/// Opens the scene, and makes what was kept of it one step of the history: these settings (of B, too, where there are
/// `other` ones; else of the edited side), and what is `give`n. False, after the reason was shown: it cannot be opened.
bool Window::bringBack(const std::filesystem::path& scene, const Settings& settings,
                       const std::optional<Settings>& other, const std::string& step,
                       const std::function<void(EditState&)>& give) {
  const auto shown = [&] { return session_.pipeline && lastingPath(session_.pipeline->scene().path) == scene; };
  if (!shown()) {
    const Settings before = std::exchange(session_.edited, settings);
    open(scene);
    if (!shown()) session_.edited = before;
  }
  if (!shown()) return false;
  session_.seeEdits(/*held=*/false);
  if (other && !session_.comparison) builder_.compare();
  EditState state = editStateOf(session_);
  const bool editsB = state.b && !other && session_.comparison->editsB;
  (editsB ? *state.b : state.a).settings = settings;
  if (state.b && other) state.b->settings = *other;
  give(state);
  restore(session_, state);
  session_.history.call(step);
  session_.seeEdits(/*held=*/false);
  return true;
}

/// The picture of a file, unless it is there; where it cannot be read that is said, and the one that is there stays.
template <class Picture>
void Window::bring(std::shared_ptr<const Picture>& into, const std::optional<std::filesystem::path>& file,
                   const std::optional<std::string>& sha256, Picture (*read)(const std::filesystem::path&)) {
  if (!file || (into && sha256 && into->sha256 == *sha256)) return;
  try {
    into = std::make_shared<const Picture>(read(*file));
  } catch (const Error& error) {
    session_.error(error.what());
  }
}

bool Window::take(const Autosave& found) {
  const auto give = [&](EditState& state) {
    state.edits = found.edits;
    bring(state.sky, found.sky, {}, readSky);
    bring(state.reference, found.reference, {}, readReference);
    state.view = found.view;
    state.camera = found.camera;
  };
  if (!bringBack(found.scene, found.settings, found.other, fmt::format("unsaved work of {}", timeInWords(found.time)),
                 give))
    return false;
  if (found.edits.sceneSha256 != session_.pipeline->scene().sha256)
    session_.note(fmt::format("{} has changed since this was kept", found.scene.filename().string()));
  return true;
}

/// What a capture or a recording was made of, in one step. Bookmarks stay: they are no part of a picture.
void Window::replay(const std::filesystem::path& manifest) {
  try {
    const CaptureEntry entry = readCapture(manifest, session_.defaults);
    const Config& config = entry.config;
    const std::filesystem::path scene = lastingPath(*config.scene);
    const auto give = [&](EditState& state) {
      const std::vector<SceneNode>& nodes = session_.pipeline->scene().nodes;
      state.edits.lights = config.lights;
      state.edits.materials = config.materials;
      state.edits.hidden = hiddenPaths(nodes, config.hidden);
      bring(state.sky, config.sky, config.skySha256, readSky);
      bring(state.reference, config.reference, config.referenceSha256, readReference);
      if (entry.view) state.view = *entry.view;
      if (!config.cameras.empty()) state.camera = config.cameras.front();
      for (SideEdits* side : {&state.a, state.b ? &*state.b : nullptr})
        if (side && (side->settings == entry.settings || (entry.other && side->settings == *entry.other)))
          side->saved = side->settings;  // the manifest holds them
      for (const auto& unknown :
           {unknownMaterials(session_.pipeline->scene(), config.materials), unknownNodes(nodes, config.hidden)})
        for (const std::string& words : unknown) session_.note(fmt::format("{}: {}", entry.name, words));
    };
    if (!bringBack(scene, entry.settings, entry.other, "replay " + entry.name, give)) return;
    session_.note(fmt::format("The window is as it was for {}, {}", entry.name, timeInWords(entry.time)));
    if (config.sceneSha256 && *config.sceneSha256 != session_.pipeline->scene().sha256)
      session_.note(fmt::format("{} has changed since then", scene.filename().string()));
  } catch (const Error& error) {
    session_.error(error.what());
  }
  framesLeft_ = kFramesPerEvent;
}

}  // namespace irad
