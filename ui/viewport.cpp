#include "ui/viewport.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "renderer/forward.h"
#include "ui/imgui.h"
#include "ui/imgui_layer.h"
#include "ui/outline.h"
#include "ui/overlay.h"
#include "ui/theme.h"

namespace irad {

Picture::Picture(const Rect& rect, const Rect& window, const Scene& scene, const Camera& camera, glm::uvec2 size)
    : rect_(rect),
      window_(window),
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
  return c.z <= c.w ? std::optional(onScreen(c)) : std::nullopt;  // beyond the near plane
}

std::optional<std::pair<glm::vec2, glm::vec2>> Picture::project(const glm::dvec3& from, const glm::dvec3& to) const {
  glm::dvec4 a = clip(from), b = clip(to);
  const auto front = [](const glm::dvec4& p) { return p.w - p.z; };  // of the near plane: >= 0
  if (front(a) < 0 && front(b) < 0) return std::nullopt;
  if (front(a) < 0) a = glm::mix(a, b, front(a) / (front(a) - front(b)));
  if (front(b) < 0) b = glm::mix(b, a, front(b) / (front(b) - front(a)));
  return std::pair(onScreen(a), onScreen(b));
}

std::pair<glm::dvec3, glm::dvec3> Picture::ray(glm::vec2 screen) const {
  const glm::dvec2 share = glm::dvec2(screen - rect_.position) / glm::dvec2(rect_.size);
  const glm::dmat4 inverse = glm::inverse(viewProjection_);
  const auto at = [&](double depth) {
    const glm::dvec4 p = inverse * glm::dvec4(share.x * 2 - 1, 1 - share.y * 2, depth, 1);
    return glm::dvec3(p) / p.w + origin_;
  };
  const glm::dvec3 start = at(1);  // depth is 1 at the near plane
  return {start, glm::normalize(at(0) - start)};
}

glm::uvec2 Picture::pixel(glm::vec2 screen) const {
  // Multiplied first: where a pixel is one of the screen's, nothing is rounded.
  const glm::vec2 at = (screen - rect_.position) * glm::vec2(size_) / rect_.size;
  return glm::uvec2(glm::clamp(at, glm::vec2(0), glm::vec2(size_ - 1u)));
}

std::pair<glm::vec2, glm::vec2> Picture::area(glm::uvec2 pixel) const {
  const glm::vec2 one = rect_.size / glm::vec2(size_), low = rect_.position + one * glm::vec2(pixel);
  return {low, low + one};
}

Rect Picture::clear() const {
  return {window_.position, {window_.size.x, std::max(window_.size.y - statusHeight(window_.size.x), 1.0f)}};
}

float statusLine() {
  return std::ceil(1.6f * ImGui::GetFontSize());
}
float statusHeight(float width) {
  return statusLine() * (width < 44 * ImGui::GetFontSize() ? 2.0f : 1.0f);
}
bool statusAbove(const Rect& window, float mouseY) {
  return mouseY >= window.position.y + window.size.y - statusHeight(window.size.x);
}

Viewport::Viewport() {
#define IRAD_MAKE_OVERLAY(name) overlays_.push_back(make##name##Overlay());
  IRAD_OVERLAYS(IRAD_MAKE_OVERLAY)
#undef IRAD_MAKE_OVERLAY
}

/// The mouse on the invisible button over the picture, which has just been submitted.
PictureMouse Viewport::mouse() {
  const ImGuiIO& io = ImGui::GetIO();
  PictureMouse m;
  m.position = {io.MousePos.x, io.MousePos.y};
  m.hovered = ImGui::IsItemHovered() || ImGui::IsItemActive();
  m.pressed = ImGui::IsItemActivated() && ImGui::IsMouseDown(ImGuiMouseButton_Left);
  // Movement before the button was pressed is no drag, also where a slow frame sees both at once.
  if (!ImGui::IsItemActivated()) m.delta = {io.MouseDelta.x, io.MouseDelta.y};
  if (m.pressed) moved_ = false;
  moved_ = moved_ || ImGui::IsMouseDragging(ImGuiMouseButton_Left);
  m.dragged = ImGui::IsItemActive() && ImGui::IsMouseDown(ImGuiMouseButton_Left) && moved_;
  m.clicked = ImGui::IsItemDeactivated() && ImGui::IsMouseReleased(ImGuiMouseButton_Left) && !moved_;
  m.shift = io.KeyShift;
  m.control = io.KeyCtrl;
  return m;
}

namespace {

/// The picture; in a comparison A's left and B's right part, or one of the two. Of the whole one in `picture` what is
/// in `window`.
void drawPictures(Session& session, ImGuiLayer& layer, const Rect& picture, const Rect& window) {
  const ImVec2 size{window.size.x, window.size.y};
  const glm::vec2 first = (window.position - picture.position) / picture.size, part = window.size / picture.size;
  const bool zoomed = session.pointing.zoom.on();
  const auto image = [&](const Image& of, float from, float to) {
    const auto share = [&](float x) { return first.x + x / size.x * part.x; };
    ImGui::SetCursorPos({from, 0});
    if (from < to)
      ImGui::Image(layer.texture(of, {.nearest = zoomed}), {to - from, size.y}, {share(from), first.y},
                   {share(to), first.y + part.y});
    ImGui::SetCursorPos({0, 0});
  };
  const auto both = [&](const Image& left, const Image& right, float split) {
    const float edge = std::clamp(std::round((split - first.x) / part.x * size.x), 0.0f, size.x);
    image(left, 0, edge);
    image(right, edge, size.x);
  };
  if (!session.comparison) {
    if (!session.targets.display) return;
    const bool split = session.split && session.split->targets.display;
    return both(session.targets.display, split ? session.split->targets.display : session.targets.display,
                split ? session.split->share : 1);
  }
  const Image &a = session.sideA().targets.display, &b = session.sideB().targets.display;
  if (!a || !b) return;
  const Comparison& comparison = *session.comparison;
  if (comparison.show == Comparison::Show::Difference && comparison.difference.display) {
    return image(comparison.difference.display, 0, size.x);
  }
  const float split = comparison.show == Comparison::Show::Split ? comparison.split
                      : comparison.show == Comparison::Show::A   ? 1.0f
                                                                 : 0.0f;
  both(a, b, split);
}

/// The line between A and B, or the picture and the reference, with their names; true while it has the mouse.
bool drawSplit(Session& session, const Rect& picture, const Rect& where, const PictureMouse& mouse, bool& dragging) {
  const bool reference = !session.comparison && session.split && session.split->targets.display;
  if ((!session.comparison && !reference) || !session.targets.display) return false;
  ImDrawList& list = *ImGui::GetWindowDrawList();
  const float em = ImGui::GetFontSize();
  // Below the status line where that is above.
  const float status = mouse.hovered && statusAbove(where, mouse.position.y) ? statusHeight(where.size.x) : 0;
  const auto letter = [&](const char* text, float x, bool edited) {
    const ImVec2 at{x, where.position.y + status + em * 0.5f}, half = ImGui::CalcTextSize(text);
    const float wide = std::max(em * 0.7f, half.x / 2 + em * 0.3f);
    list.AddRectFilled({at.x - wide, at.y}, {at.x + wide, at.y + em * 1.5f}, IM_COL32(0, 0, 0, 150), em * 0.2f);
    list.AddText({at.x - half.x / 2, at.y + em * 0.25f}, ImGui::GetColorU32(edited ? theme::accent : theme::text),
                 text);
    if (Controls::current())
      ImGui::tellPlace(fmt::format("side={}", text).c_str(), {at.x - wide, at.y}, {at.x + wide, at.y + em * 1.5f});
  };
  float& split = reference ? session.split->share : session.comparison->split;
  const auto line = [&](const char* left, bool leftEdited, const char* right, bool rightEdited) {
    const float x = picture.position.x + std::round(split * picture.size.x);
    const bool near = mouse.hovered && std::abs(mouse.position.x - x) < em * 0.5f;
    if (mouse.pressed) dragging = near;
    if (!mouse.hovered) dragging = false;
    if (near || dragging) ImGui::SetMouseCursor(ImGuiMouseCursor_ResizeEW);
    if (dragging && mouse.dragged)
      split = std::clamp((mouse.position.x - picture.position.x) / picture.size.x, 0.0f, 1.0f);
    list.AddLine({x, where.position.y}, {x, where.position.y + where.size.y},
                 ImGui::GetColorU32(dragging ? theme::accent : theme::text), std::max(1.0f, em / 14));
    const auto away = [&](const char* text) {
      return std::max(em * 1.2f, ImGui::CalcTextSize(text).x / 2 + em * 0.8f);
    };
    letter(left, x - away(left), leftEdited);
    letter(right, x + away(right), rightEdited);
    return dragging || (near && mouse.pressed);
  };
  if (reference) return line("picture", false, "reference", false);
  const Comparison& comparison = *session.comparison;
  if (comparison.show == Comparison::Show::Difference) {
    letter("B \u2212 A", where.position.x + where.size.x / 2, false);
    return false;
  }
  if (comparison.show != Comparison::Show::Split) {
    const bool a = comparison.show == Comparison::Show::A;
    letter(a ? "A" : "B", where.position.x + where.size.x / 2, a != comparison.editsB);
    return false;
  }
  return line("A", !comparison.editsB, "B", comparison.editsB);
}

/// The pixel at a point of the screen, and whose.
Pointing::Over under(const Session& session, const Picture& picture, glm::vec2 screen) {
  const float share = (screen.x - picture.rect().position.x) / picture.rect().size.x;
  return {picture.pixel(screen), session.comparison && session.comparison->showsOther(share),
          !session.comparison && session.split && session.split->targets.display && share >= session.split->share};
}

/// Turns the camera as the mouse moves, with Alt about what is chosen.
void look(Session& session, glm::vec2 delta) {
  if (ImGui::GetIO().KeyAlt && session.built)
    session.camera.orbit(delta.x, delta.y, session.chosenSphere().value_or(session.sceneSphere()).centre);
  else
    session.camera.look(delta.x, delta.y);
  session.viewDirty = true;
  // While a rebuild runs the last picture stays, and what lies over it.
  if (session.built && !session.work) session.shown = session.camera.camera();
}

}  // namespace

void Viewport::draw(Session& session, ImGuiLayer& layer, const Rect& where) {
  ImGui::PushStyleVar(ImGuiStyleVar_WindowPadding, ImVec2(0, 0));
  ImGui::PushStyleVar(ImGuiStyleVar_WindowBorderSize, 0.0f);
  beginTile("##viewport", where, /*filled=*/false, /*scrolls=*/false);
  ImGui::PopStyleVar(2);
  const ImVec2 size{std::max(where.size.x, 1.0f), std::max(where.size.y, 1.0f)};
  Zoom& zoom = session.pointing.zoom;
  const Rect whole = zoom.picture(where);
  drawPictures(session, layer, whole, where);
  showOutline(session, layer, whole);
  ImGui::InvisibleButton(
      "##viewport", size,
      ImGuiButtonFlags_MouseButtonLeft | ImGuiButtonFlags_MouseButtonRight | ImGuiButtonFlags_MouseButtonMiddle);
  const bool active = ImGui::IsItemActive(), hovered = ImGui::IsItemHovered();
  PictureMouse m = mouse();

  bool taken = drawSplit(session, whole, where, m, dragsSplit_);
  const bool middle = active && ImGui::IsMouseDown(ImGuiMouseButton_Middle);
  // Before the overlays, so that they are drawn for the camera that this frame's picture gets. What the press gave to
  // an overlay is not looked around with.
  if (!taken && active && held_ == nullptr && !middle && m.delta != glm::vec2(0)) look(session, m.delta);
  session.pointing.over.reset();
  session.legends.clear();
  if (session.built && session.targets.display) {
    const Picture picture(whole, where, session.pipeline->scene(), session.shown, session.targets.size);
    if (hovered) session.pointing.over = under(session, picture, m.position);
    for (const auto& overlay : overlays_) {
      const bool offered = !taken && (held_ == nullptr || held_ == overlay.get());
      if (!overlay->draw(session, picture, offered ? m : PictureMouse{}) || !offered) continue;
      taken = true;
      if (m.pressed) held_ = overlay.get();
    }
  }
  if (!active) held_ = nullptr;

  // A slow frame sees the press when the mouse has moved on: what was under it has been pressed.
  if (middle && zoom.on()) zoom.pan(where, m.position - lastMouse_);
  if (middle || (hovered && !active)) lastMouse_ = m.position;
  const float wheel = ImGui::GetIO().MouseWheel;
  if (hovered && wheel != 0 && m.control)
    zoom.turn(where, m.position, wheel);
  else if (hovered && wheel != 0)
    session.camera.changeSpeed(wheel);
  endTile();
}

}  // namespace irad
