#include "ui/viewport.h"

#include <imgui.h>

#include <algorithm>

#include "ui/imgui_layer.h"
#include "ui/overlay.h"

namespace irad {

Picture::Picture(const Rect& rect, const Scene& scene, const Camera& camera, glm::uvec2 size)
    : rect_(rect),
      size_(size),
      origin_(scene.origin),
      viewProjection_(makeGpuCamera(scene, camera, size).viewProjection) {}

glm::dvec4 Picture::clip(const glm::dvec3& world) const {
  return viewProjection_ * glm::dvec4(world - origin_, 1.0);
}

glm::vec2 Picture::onScreen(const glm::dvec4& c) const {
  const glm::dvec2 share = glm::dvec2(c.x, -c.y) / c.w * 0.5 + 0.5;
  return rect_.position + glm::vec2(share) * rect_.size;
}

std::optional<glm::vec2> Picture::project(const glm::dvec3& world) const {
  const glm::dvec4 c = clip(world);
  return c.z >= 0 ? std::optional(onScreen(c)) : std::nullopt;
}

std::optional<std::pair<glm::vec2, glm::vec2>> Picture::project(const glm::dvec3& from, const glm::dvec3& to) const {
  glm::dvec4 a = clip(from), b = clip(to);
  if (a.z < 0 && b.z < 0) return std::nullopt;
  if (a.z < 0) a = glm::mix(a, b, a.z / (a.z - b.z));
  if (b.z < 0) b = glm::mix(b, a, b.z / (b.z - a.z));
  return std::pair(onScreen(a), onScreen(b));
}

std::pair<glm::dvec3, glm::dvec3> Picture::ray(glm::vec2 screen) const {
  const glm::dvec2 share = glm::dvec2(screen - rect_.position) / glm::dvec2(rect_.size);
  const glm::dmat4 inverse = glm::inverse(viewProjection_);
  const auto at = [&](double depth) {
    const glm::dvec4 p = inverse * glm::dvec4(share.x * 2 - 1, 1 - share.y * 2, depth, 1);
    return glm::dvec3(p) / p.w + origin_;
  };
  const glm::dvec3 start = at(0);
  return {start, glm::normalize(at(1) - start)};
}

glm::uvec2 Picture::pixel(glm::vec2 screen) const {
  const glm::vec2 share = (screen - rect_.position) / rect_.size;
  return glm::uvec2(glm::clamp(share * glm::vec2(size_), glm::vec2(0), glm::vec2(size_ - 1u)));
}

Viewport::Viewport() {
#define IRAD_MAKE_OVERLAY(name) overlays_.push_back(make##name##Overlay());
  IRAD_OVERLAYS(IRAD_MAKE_OVERLAY)
#undef IRAD_MAKE_OVERLAY
}

/// Of the invisible button over the picture, which has just been submitted.
PictureMouse Viewport::mouse() {
  const ImGuiIO& io = ImGui::GetIO();
  PictureMouse m;
  m.position = {io.MousePos.x, io.MousePos.y};
  m.hovered = ImGui::IsItemHovered() || ImGui::IsItemActive();
  m.pressed = ImGui::IsItemActivated() && ImGui::IsMouseDown(ImGuiMouseButton_Left);
  // What the mouse moved before it was pressed is no drag, also where a slow frame sees both at once.
  if (!ImGui::IsItemActivated()) m.delta = {io.MouseDelta.x, io.MouseDelta.y};
  if (m.pressed) moved_ = false;
  moved_ = moved_ || ImGui::IsMouseDragging(ImGuiMouseButton_Left);
  m.dragged = ImGui::IsItemActive() && ImGui::IsMouseDown(ImGuiMouseButton_Left) && moved_;
  m.clicked = ImGui::IsItemDeactivated() && ImGui::IsMouseReleased(ImGuiMouseButton_Left) && !moved_;
  m.shift = io.KeyShift;
  m.control = io.KeyCtrl;
  return m;
}

void Viewport::draw(Session& session, ImGuiLayer& layer, const Rect& where) {
  ImGui::PushStyleVar(ImGuiStyleVar_WindowPadding, ImVec2(0, 0));
  ImGui::PushStyleVar(ImGuiStyleVar_WindowBorderSize, 0.0f);
  beginTile("##viewport", where, /*filled=*/false, /*scrolls=*/false);
  ImGui::PopStyleVar(2);
  const ImVec2 size{std::max(where.size.x, 1.0f), std::max(where.size.y, 1.0f)};
  if (session.targets.display) {
    ImGui::Image(layer.texture(session.targets.display), size);
    ImGui::SetCursorPos({0, 0});
  }
  ImGui::InvisibleButton("##look", size, ImGuiButtonFlags_MouseButtonLeft | ImGuiButtonFlags_MouseButtonRight);
  const bool active = ImGui::IsItemActive(), hovered = ImGui::IsItemHovered();
  PictureMouse m = mouse();

  bool taken = false;
  if (session.built && session.targets.display) {
    const Picture picture(where, session.pipeline->scene(), session.shown, session.targets.size);
    for (const auto& overlay : overlays_) {
      const bool offered = !taken && (held_ == nullptr || held_ == overlay.get());
      if (!overlay->draw(session, picture, offered ? m : PictureMouse{}) || !offered) continue;
      taken = true;
      if (m.pressed) held_ = overlay.get();
    }
  }
  if (!active) held_ = nullptr;

  if (!taken && active && m.delta != glm::vec2(0)) {
    session.camera.look(m.delta.x, m.delta.y);
    session.viewDirty = true;
  }
  const float wheel = ImGui::GetIO().MouseWheel;
  if (hovered && wheel != 0) session.camera.changeSpeed(wheel);
  endTile();
}

}  // namespace irad
