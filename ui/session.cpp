#include "ui/session.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

namespace irad {

void Session::say(Message::Kind kind, std::string text) {
  constexpr size_t most = 4;
  fmt::print(stderr, "irad: {}\n", text);
  std::erase_if(messages, [&](const Message& m) { return m.text == text; });
  messages.push_back({kind, std::move(text)});
  if (messages.size() > most) messages.erase(messages.begin());
}

void Session::useSceneCamera(int index) {
  if (!pipeline || pipeline->scene().cameras.empty()) return;
  const Scene& scene = pipeline->scene();
  sceneCamera = std::clamp(index, 0, static_cast<int>(scene.cameras.size()) - 1);
  camera.start(scene.cameras[static_cast<size_t>(sceneCamera)], glm::distance(scene.boundsMin, scene.boundsMax));
  viewDirty = true;
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
    text += EnumNames<Redo>::names[stage];
  }
  return text;
}

}  // namespace irad
