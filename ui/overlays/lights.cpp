// Handles of the lights over the picture: a click chooses a light, a drag moves it, a drag of the square at the end of
// its arrow aims it.

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "ui/imgui.h"
#include "ui/light_color.h"
#include "ui/theme.h"
#include "ui/viewport.h"
#include "ui/widgets.h"

namespace irad {
namespace {

constexpr ImU32 kEdge = IM_COL32(0, 0, 0, 200);

ImVec2 vec(glm::vec2 v) {
  return {v.x, v.y};
}

enum class Handle { None, Position, Aim };

/// A handle, and of which light.
struct Hit {
  Handle handle = Handle::None;
  int light = -1;
  explicit operator bool() const { return handle != Handle::None; }
};

class LightsOverlay : public Overlay {
 public:
  bool draw(Session& session, const Picture& picture, const PictureMouse& mouse) override {
    SceneEdits& edits = session.edits;
    const Scene& scene = session.pipeline->scene();
    if (!edits.showHandles) return release();
    if (edits.selected != aimed_) {
      aimed_ = edits.selected;
      reach_ = 0.15 * std::max<double>(glm::distance(scene.boundsMin, scene.boundsMax), 1e-6);
    }

    const bool down = ImGui::IsMouseDown(ImGuiMouseButton_Left);
    if (mouse.pressed) {
      // A slow frame sees the press when the mouse has moved on: what it was over in the last one has been pressed.
      if (!over_) point(edits, picture, mouse);
      held_ = over_;
      if (held_) {
        edits.selected = held_.light;
        anchor(edits, overAt_, mouse.shift);
      }
    } else if (held_ && mouse.dragged) {
      drag(edits, session.shown, picture, mouse);
    }
    const bool clicked = held_ && mouse.clicked;
    if (!down) {
      held_ = {};
      over_ = {};
      if (mouse.hovered && !clicked) point(edits, picture, mouse);
    }
    const Hit active = down ? held_ : over_;
    const bool taken = active || clicked;

    for (int i = 0; i < static_cast<int>(edits.lights.size()); ++i)
      drawLight(edits, picture, i, active && i == active.light);
    if (active) {
      ImGui::SetMouseCursor(active.handle == Handle::Aim ? ImGuiMouseCursor_ResizeAll : ImGuiMouseCursor_Hand);
      if (!down) ImGui::SetTooltip("%s", edits.lights[static_cast<size_t>(active.light)].name.c_str());
    }
    return taken;
  }

 private:
  int aimed_ = -1;            ///< the light that reach_ is for
  double reach_ = 1;          ///< length of its arrow, scene units
  Hit held_, over_;           ///< by the pressed button; under the mouse in the last frame
  glm::vec2 overAt_{0};       ///< where it was then
  glm::dvec3 anchor_{0};      ///< where the handle was when it was taken, or when Shift changed
  glm::vec2 anchorMouse_{0};  ///< and the mouse
  bool anchorShift_ = false;

  bool release() {
    held_ = over_ = {};
    return false;
  }

  static bool aimable(const Light& light) { return lightKind(light.type).has(LIGHT_DIRECTION); }
  static float radius() { return 0.45f * ImGui::GetFontSize(); }
  glm::dvec3 tip(const Light& light) const { return light.position + glm::dvec3(light.direction) * reach_; }

  void point(const SceneEdits& edits, const Picture& picture, const PictureMouse& mouse) {
    over_ = under(edits, picture, mouse.position);
    overAt_ = mouse.position;
  }

  /// The light nearest to the mouse, else the end of the chosen one's arrow.
  Hit under(const SceneEdits& edits, const Picture& picture, glm::vec2 mouse) const {
    const auto distance = [&](const glm::dvec3& world) {
      const std::optional<glm::vec2> at = picture.project(world);
      return at ? glm::distance(*at, mouse) : INFINITY;
    };
    float nearest = 1.6f * radius();
    Hit hit;
    const auto count = static_cast<int>(edits.lights.size());
    for (int i = 0; i < count; ++i) {
      float d = distance(edits.lights[static_cast<size_t>(i)].position);
      if (i == edits.selected) d -= 1;  // of lights in one place (duplicates) the chosen one
      if (d >= nearest) continue;
      nearest = d;
      hit = {Handle::Position, i};
    }
    if (hit || edits.selected < 0 || edits.selected >= count) return hit;
    const Light& chosen = edits.lights[static_cast<size_t>(edits.selected)];
    if (aimable(chosen) && distance(tip(chosen)) < nearest) hit = {Handle::Aim, edits.selected};
    return hit;
  }

  void anchor(const SceneEdits& edits, glm::vec2 mouse, bool shift) {
    const Light& light = edits.lights.at(static_cast<size_t>(edits.selected));
    anchor_ = held_.handle == Handle::Aim ? tip(light) : light.position;
    anchorMouse_ = mouse;
    anchorShift_ = shift;
  }

  void drag(SceneEdits& edits, const Camera& camera, const Picture& picture, const PictureMouse& mouse) {
    Light* light = edits.light();
    if (light == nullptr) return;
    if (mouse.shift != anchorShift_) anchor(edits, mouse.position, mouse.shift);
    const glm::dvec3 at =
        mouse.shift ? alongView(camera, picture, mouse.position) : inPlane(camera, picture, mouse.position);
    if (!(std::max({std::abs(at.x), std::abs(at.y), std::abs(at.z)}) <= kMaxCoordinate)) return;
    if (held_.handle == Handle::Position) {
      light->position = at;
      return;
    }
    const glm::dvec3 aim = at - light->position;
    if (!(glm::length(aim) > 1e-6 * reach_)) return;
    light->direction = glm::vec3(glm::normalize(aim));
    reach_ = glm::length(aim);
  }

  /// The anchor moved with the mouse in its plane parallel to the picture.
  glm::dvec3 inPlane(const Camera& camera, const Picture& picture, glm::vec2 mouse) const {
    const glm::dvec3 normal(camera.orientation * glm::vec3(0, 0, -1));
    const auto meet = [&](glm::vec2 screen) {
      const auto [start, direction] = picture.ray(screen);
      return start + direction * (glm::dot(anchor_ - start, normal) / glm::dot(direction, normal));
    };
    return anchor_ + meet(mouse) - meet(anchorMouse_);
  }

  /// The anchor moved along the line of sight: away when the mouse goes up, twice as far a third of the picture higher.
  glm::dvec3 alongView(const Camera& camera, const Picture& picture, glm::vec2 mouse) const {
    const double share = (anchorMouse_.y - mouse.y) / picture.rect().size.y;
    if (camera.orthographic)
      return anchor_ + glm::dvec3(camera.orientation * glm::vec3(0, 0, -1)) * (share * 2.0 * camera.ymag);
    return camera.position + (anchor_ - camera.position) * std::exp2(3.0 * share);
  }

  void drawLight(const SceneEdits& edits, const Picture& picture, int index, bool hot) const {
    const Light& light = edits.lights[static_cast<size_t>(index)];
    const LightKind& kind = lightKind(light.type);
    const bool chosen = index == edits.selected;
    ImDrawList& list = *ImGui::GetWindowDrawList();
    const ImU32 accent = ImGui::ColorConvertFloat4ToU32(theme::accent);
    if (chosen && aimable(light)) drawAim(list, light, picture, accent);
    const std::optional<glm::vec2> at = picture.project(light.position);
    if (!at) return;
    const float r = radius() * (hot ? 1.25f : 1.0f);
    if (kind.has(LIGHT_DISTANT))
      for (int ray = 0; ray < 8; ++ray) {
        const float angle = static_cast<float>(ray) * std::numbers::pi_v<float> / 4;
        const glm::vec2 out(std::cos(angle), std::sin(angle));
        line(list, *at + out * (r * 1.25f), *at + out * (r * 1.8f), displayColor(light.color));
      }
    list.AddCircleFilled(vec(*at), r + 1.5f, kEdge);
    list.AddCircleFilled(vec(*at), r, displayColor(light.color));
    if (kind.has(LIGHT_CONE)) list.AddCircleFilled(vec(*at), r * 0.45f, kEdge);
    if (chosen) list.AddCircle(vec(*at), r + 3.0f, accent, 0, 2.0f);
  }

  /// The arrow with its square, and of a spot the rim of its cone.
  void drawAim(ImDrawList& list, const Light& light, const Picture& picture, ImU32 accent) const {
    if (const auto shaft = picture.project(light.position, tip(light))) line(list, shaft->first, shaft->second, accent);
    if (lightKind(light.type).has(LIGHT_CONE) && light.outerCos > 0.05f) drawRim(list, light, picture, accent);
    const std::optional<glm::vec2> at = picture.project(tip(light));
    if (!at) return;
    const glm::vec2 half(0.6f * radius());
    list.AddRectFilled(vec(*at - half - 1.5f), vec(*at + half + 1.5f), kEdge);
    list.AddRectFilled(vec(*at - half), vec(*at + half), accent);
  }

  void drawRim(ImDrawList& list, const Light& light, const Picture& picture, ImU32 accent) const {
    constexpr int sides = 32;
    const glm::dvec3 axis(light.direction);
    const glm::dvec3 across =
        glm::normalize(glm::cross(axis, std::abs(axis.y) < 0.9 ? glm::dvec3(0, 1, 0) : glm::dvec3(1, 0, 0)));
    const glm::dvec3 up = glm::cross(across, axis);
    const double width = reach_ * std::sqrt(1.0 - light.outerCos * light.outerCos) / light.outerCos;
    const auto rim = [&](int i) {
      const double angle = 2 * std::numbers::pi * i / sides;
      return tip(light) + (across * std::cos(angle) + up * std::sin(angle)) * width;
    };
    for (int i = 0; i < sides; ++i) {
      if (const auto side = picture.project(rim(i), rim(i + 1))) line(list, side->first, side->second, accent);
      if (i % 8 != 0) continue;
      if (const auto edge = picture.project(light.position, rim(i))) line(list, edge->first, edge->second, accent);
    }
  }

  /// Seen on any ground.
  static void line(ImDrawList& list, glm::vec2 from, glm::vec2 to, ImU32 color) {
    list.AddLine(vec(from), vec(to), kEdge, 3.0f);
    list.AddLine(vec(from), vec(to), color, 1.5f);
  }
};

}  // namespace

std::unique_ptr<Overlay> makeLightsOverlay() {
  return std::make_unique<LightsOverlay>();
}

}  // namespace irad
