// Handles of the lights over the picture: a click chooses a light, a drag moves it. The chosen one has axes, and an
// arrow the way it shines: a drag of an axis, or of the square between two, moves it there; one of the arrow's end aims
// it. With Ctrl what is dragged goes to the surface under the mouse.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "renderer/scene/first_surface.h"
#include "ui/handles.h"
#include "ui/imgui.h"
#include "ui/light_color.h"
#include "ui/theme.h"
#include "ui/viewport.h"
#include "ui/widgets.h"

namespace irad {
namespace {

enum class Handle { None, Position, Aim, Axis, Plane };
constexpr std::array kPlaneNames{"yz", "zx", "xy"};  ///< by the axis that stands on it

/// A handle, and of which light.
struct Hit {
  Handle handle = Handle::None;
  int light = -1;
  int axis = 0;  ///< Axis: that; Plane: that across it
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
        anchor(edits, overAt_, mouse);
      }
    } else if (held_ && mouse.dragged) {
      drag(session, picture, mouse);
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
    if (const Light* chosen = edits.light()) drawAxes(*chosen, picture, active);
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
  glm::dvec3 anchor_{0};      ///< where the handle was when it was taken, or when Shift or Ctrl changed
  glm::vec2 anchorMouse_{0};  ///< and the mouse
  bool anchorShift_ = false, anchorControl_ = false;

  bool release() {
    held_ = over_ = {};
    return false;
  }

  static bool aimable(const Light& light) { return lightKind(light.type).has(LIGHT_DIRECTION); }
  glm::dvec3 tip(const Light& light) const { return light.position + glm::dvec3(light.direction) * reach_; }

  void point(const SceneEdits& edits, const Picture& picture, const PictureMouse& mouse) {
    over_ = under(edits, picture, mouse.position);
    overAt_ = mouse.position;
  }

  /// The light nearest to the mouse, else of the chosen one the end of its arrow, an axis, a plane.
  Hit under(const SceneEdits& edits, const Picture& picture, glm::vec2 mouse) const {
    const auto distance = [&](const glm::dvec3& world) {
      const std::optional<glm::vec2> at = picture.project(world);
      return at ? glm::distance(*at, mouse) : INFINITY;
    };
    float nearest = 1.6f * handleRadius();
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
    if (aimable(chosen) && distance(tip(chosen)) < nearest) return {Handle::Aim, edits.selected};
    const std::optional<Axes> axes = axesOf(chosen, picture);
    if (!axes) return {};
    float least = 0.5f * ImGui::GetFontSize();
    for (int axis = 0; axis < 3; ++axis) {
      if (!axes->seen(axis)) continue;
      const float d = distanceToSegment(mouse, axes->at(axis, 0.3f), axes->at(axis, 1.1f));
      if (d >= least) continue;
      least = d;
      hit = {Handle::Axis, edits.selected, axis};
    }
    for (int axis = 0; axis < 3 && !hit; ++axis)
      if (axes->seenPlane(axis) && axes->holds(axis, mouse)) hit = {Handle::Plane, edits.selected, axis};
    return hit;
  }

  /// The axes of a light, as long in the picture as they are drawn: where they end on the screen, from the light.
  struct Axes {
    glm::vec2 centre;
    std::array<glm::vec2, 3> way;
    float length;  ///< of an axis that lies across the line of sight

    glm::vec2 at(int axis, float share) const { return centre + share * way[static_cast<size_t>(axis)]; }
    /// Long enough to be taken: what points at the eye cannot be dragged along.
    bool seen(int axis) const { return glm::length(way[static_cast<size_t>(axis)]) > 0.25f * length; }
    /// The corners of the square between the other two axes.
    std::array<glm::vec2, 4> square(int axis) const {
      const glm::vec2 a = way[static_cast<size_t>((axis + 1) % 3)], b = way[static_cast<size_t>((axis + 2) % 3)];
      return {centre + 0.4f * a + 0.4f * b, centre + 0.65f * a + 0.4f * b, centre + 0.65f * a + 0.65f * b,
              centre + 0.4f * a + 0.65f * b};
    }
    float area(int axis) const {
      const glm::vec2 a = way[static_cast<size_t>((axis + 1) % 3)], b = way[static_cast<size_t>((axis + 2) % 3)];
      return a.x * b.y - a.y * b.x;
    }
    bool seenPlane(int axis) const { return std::abs(area(axis)) > 0.15f * length * length; }
    bool holds(int axis, glm::vec2 p) const {
      const std::array<glm::vec2, 4> corner = square(axis);
      bool within = true;
      for (size_t i = 0; i < 4; ++i) {
        const glm::vec2 edge = corner[(i + 1) % 4] - corner[i], to = p - corner[i];
        within = within && (edge.x * to.y - edge.y * to.x) * area(axis) >= 0;
      }
      return within;
    }
  };
  /// None where the light is behind the eye, or as good as in it.
  static std::optional<Axes> axesOf(const Light& light, const Picture& picture) {
    const std::optional<glm::vec2> centre = picture.project(light.position);
    if (!centre) return std::nullopt;
    // So far in the plane of the picture is as far as an axis is long.
    const float length = 4.5f * ImGui::GetFontSize();
    const auto [start, direction] = picture.ray(*centre);
    const auto [besideStart, besideDirection] = picture.ray(*centre + glm::vec2(length, 0));
    const double depth = glm::dot(light.position - start, direction);
    const double ahead = glm::dot(besideDirection, direction);
    if (!(depth > 0 && ahead > 0)) return std::nullopt;
    const glm::dvec3 beside =
        besideStart + besideDirection * (glm::dot(light.position - besideStart, direction) / ahead);
    const double world = glm::distance(beside, light.position);
    Axes axes{*centre, {}, length};
    for (int axis = 0; axis < 3; ++axis) {
      // By a short piece: the whole axis may reach behind the eye, and is not to be drawn longer the nearer it comes.
      glm::dvec3 along(0);
      along[axis] = 0.01 * world;
      const std::optional<glm::vec2> end = picture.project(light.position + along);
      if (!end) return std::nullopt;
      axes.way[static_cast<size_t>(axis)] = 100.0f * (*end - *centre);
    }
    return axes;
  }

  static float distanceToSegment(glm::vec2 p, glm::vec2 a, glm::vec2 b) {
    const glm::vec2 along = b - a;
    const float squared = glm::dot(along, along);
    const float share = squared > 0 ? std::clamp(glm::dot(p - a, along) / squared, 0.0f, 1.0f) : 0.0f;
    return glm::distance(p, a + share * along);
  }

  /// From now on what is held moves as the mouse does from `at`, with the keys that are down.
  void anchor(const SceneEdits& edits, glm::vec2 at, const PictureMouse& mouse) {
    const Light& light = edits.lights.at(static_cast<size_t>(edits.selected));
    anchor_ = held_.handle == Handle::Aim ? tip(light) : light.position;
    anchorMouse_ = at;
    anchorShift_ = mouse.shift;
    anchorControl_ = mouse.control;
  }

  void drag(Session& session, const Picture& picture, const PictureMouse& mouse) {
    const Camera& camera = session.shown;
    Light* light = session.edits.light();
    if (light == nullptr) return;
    if (mouse.shift != anchorShift_ || mouse.control != anchorControl_) anchor(session.edits, mouse.position, mouse);
    std::optional<glm::dvec3> to;
    if (held_.handle == Handle::Axis)
      to = movedAlongAxis(picture, anchor_, held_.axis, anchorMouse_, mouse.position);
    else if (held_.handle == Handle::Plane)
      to = inPlane(axisVector(held_.axis), picture, mouse.position);
    else if (mouse.control)
      to = onSurface(session, *light, picture, mouse.position);
    else if (mouse.shift)
      to = alongView(camera, picture, mouse.position);
    else
      to = inPlane(glm::dvec3(camera.orientation * glm::vec3(0, 0, -1)), picture, mouse.position);
    if (!to || !(std::max({std::abs(to->x), std::abs(to->y), std::abs(to->z)}) <= kMaxCoordinate)) return;
    if (held_.handle != Handle::Aim) {
      light->position = *to;
      return;
    }
    const glm::dvec3 aim = *to - light->position;
    if (!(glm::length(aim) > 1e-6 * reach_)) return;
    light->direction = glm::vec3(glm::normalize(aim));
    reach_ = glm::length(aim);
  }

  /// Of the surface under the mouse: a voxel before it, or the lamp's radius where that is more; to aim at it itself.
  std::optional<glm::dvec3> onSurface(const Session& session, const Light& light, const Picture& picture,
                                      glm::vec2 mouse) const {
    const auto [start, direction] = picture.ray(mouse);
    const auto surface = firstSurface(session.pipeline->scene(), start, direction);
    if (!surface) return std::nullopt;
    if (held_.handle == Handle::Aim) return surface->position;
    return surface->position + surface->normal * std::max<double>(session.built->edge, light.radius);
  }

  /// The anchor moved with the mouse in its plane across `normal`; none where that is seen from its edge.
  std::optional<glm::dvec3> inPlane(const glm::dvec3& normal, const Picture& picture, glm::vec2 mouse) const {
    const auto meet = [&](glm::vec2 screen) -> std::optional<glm::dvec3> {
      const auto [start, direction] = picture.ray(screen);
      const double towards = glm::dot(direction, normal), t = glm::dot(anchor_ - start, normal) / towards;
      if (std::abs(towards) < 1e-3 || t < 0) return std::nullopt;
      return start + direction * t;
    };
    const std::optional<glm::dvec3> now = meet(mouse), before = meet(anchorMouse_);
    if (!now || !before) return std::nullopt;
    return anchor_ + *now - *before;
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
    const float r = handleRadius() * (hot ? 1.25f : 1.0f);
    if (kind.has(LIGHT_DISTANT))
      for (int ray = 0; ray < 8; ++ray) {
        const float angle = static_cast<float>(ray) * std::numbers::pi_v<float> / 4;
        const glm::vec2 out(std::cos(angle), std::sin(angle));
        drawHandleLine(list, *at + out * (r * 1.25f), *at + out * (r * 1.8f), displayColor(light.color));
      }
    list.AddCircleFilled(toImVec(*at), r + 1.5f, kHandleEdge);
    if (light.on)
      list.AddCircleFilled(toImVec(*at), r, displayColor(light.color));
    else
      list.AddCircle(toImVec(*at), r, displayColor(light.color), 0, 1.5f);
    if (kind.has(LIGHT_CONE)) list.AddCircleFilled(toImVec(*at), r * 0.45f, kHandleEdge);
    if (chosen) list.AddCircle(toImVec(*at), r + 3.0f, accent, 0, 2.0f);
  }

  void drawAxes(const Light& light, const Picture& picture, const Hit& active) const {
    const std::optional<Axes> axes = axesOf(light, picture);
    if (!axes) return;
    ImDrawList& list = *ImGui::GetWindowDrawList();
    ImGui::PushID("picture");
    const glm::vec2 half(0.3f * handleRadius());
    ImGui::tellPlace("light", axes->centre - half, axes->centre + half, active.handle == Handle::Position);
    if (const std::optional<glm::vec2> end = aimable(light) ? picture.project(tip(light)) : std::nullopt)
      ImGui::tellPlace("aim", *end - half, *end + half, active.handle == Handle::Aim);
    for (int axis = 0; axis < 3; ++axis) {
      const ImU32 color = kAxisColors[static_cast<size_t>(axis)];
      const auto hot = [&](Handle handle) { return active.handle == handle && active.axis == axis; };
      if (axes->seenPlane(axis)) {
        const std::array<glm::vec2, 4> corner = axes->square(axis);
        const ImU32 fill = (color & ~IM_COL32_A_MASK) | IM_COL32(0, 0, 0, hot(Handle::Plane) ? 220 : 110);
        list.AddQuadFilled(toImVec(corner[0]), toImVec(corner[1]), toImVec(corner[2]), toImVec(corner[3]), fill);
        list.AddQuad(toImVec(corner[0]), toImVec(corner[1]), toImVec(corner[2]), toImVec(corner[3]), color);
        const glm::vec2 middle = 0.5f * (corner[0] + corner[2]);
        ImGui::tellPlace(kPlaneNames[static_cast<size_t>(axis)], middle - half, middle + half, hot(Handle::Plane));
      }
      if (!axes->seen(axis)) continue;
      const glm::vec2 from = axes->at(axis, 0.3f), to = axes->at(axis, 1);
      const glm::vec2 way = glm::normalize(to - from), across(-way.y, way.x);
      const float width = handleRadius() * (hot(Handle::Axis) ? 0.8f : 0.6f);
      drawHandleLine(list, from, to, color);
      list.AddTriangleFilled(toImVec(to + way * (2 * width)), toImVec(to + across * width),
                             toImVec(to - across * width), color);
      ImGui::tellPlace(kAxisNames[static_cast<size_t>(axis)], to - half, to + half, hot(Handle::Axis));
    }
    ImGui::PopID();
  }

  /// The arrow with its square, and of a spot the rim of its cone.
  void drawAim(ImDrawList& list, const Light& light, const Picture& picture, ImU32 accent) const {
    if (const auto shaft = picture.project(light.position, tip(light)))
      drawHandleLine(list, shaft->first, shaft->second, accent);
    if (lightKind(light.type).has(LIGHT_CONE) && light.outerCos > 0.05f) drawRim(list, light, picture, accent);
    const std::optional<glm::vec2> at = picture.project(tip(light));
    if (!at) return;
    const glm::vec2 half(0.6f * handleRadius());
    list.AddRectFilled(toImVec(*at - half - 1.5f), toImVec(*at + half + 1.5f), kHandleEdge);
    list.AddRectFilled(toImVec(*at - half), toImVec(*at + half), accent);
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
      if (const auto side = picture.project(rim(i), rim(i + 1)))
        drawHandleLine(list, side->first, side->second, accent);
      if (i % 8 != 0) continue;
      if (const auto edge = picture.project(light.position, rim(i)))
        drawHandleLine(list, edge->first, edge->second, accent);
    }
  }
};

}  // namespace

std::unique_ptr<Overlay> makeLightsOverlay() {
  return std::make_unique<LightsOverlay>();
}

}  // namespace irad
