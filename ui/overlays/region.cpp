// The part of the scene that has voxels, where that is not all of it: a box over the picture. One that is given
// (SceneEdits::region, or scene.region=box) has a handle in the middle of each face, which moves the face; it is built
// when it is let go.
#include <algorithm>
#include <cmath>

#include "ui/handles.h"
#include "ui/theme.h"

namespace irad {
namespace {

constexpr int kFaces = 6;  ///< the low ones of x, y and z, then the high ones
constexpr std::array kFaceNames{"least x", "least y", "least z", "largest x", "largest y", "largest z"};

struct Box {
  glm::dvec3 lo, hi;  ///< world
  glm::dvec3 corner(int i) const { return {i & 1 ? hi.x : lo.x, i & 2 ? hi.y : lo.y, i & 4 ? hi.z : lo.z}; }
  glm::dvec3 middle(int face) const {
    glm::dvec3 at = 0.5 * (lo + hi);
    at[face % 3] = face < 3 ? lo[face % 3] : hi[face % 3];
    return at;
  }
};

std::optional<Box> given(const Session& session) {
  const RegionSettings& r = session.edited.scene.region;
  if (r.mode == RegionMode::box) return Box{{r.x0, r.y0, r.z0}, {r.x1, r.y1, r.z1}};
  const std::optional<RegionBox>& box = session.edits.region;
  return r.mode == RegionMode::automatic && box ? std::optional(Box{box->least, box->largest}) : std::nullopt;
}

class RegionOverlay : public Overlay {
 public:
  bool draw(Session& session, const Picture& picture, const PictureMouse& mouse) override {
    if (!session.built || !session.edits.showHandles) return release();
    const Scene& scene = session.pipeline->scene();
    const std::optional<Box> wanted = given(session);
    if (!wanted) {
      const SceneRegion& found = session.built->region;
      if (!found.whole) drawEdges(picture, {scene.origin + glm::dvec3(found.lo), scene.origin + glm::dvec3(found.hi)});
      return release();
    }
    if (!held_) box_ = *wanted;

    const bool down = ImGui::IsMouseDown(ImGuiMouseButton_Left);
    if (mouse.pressed) {
      // A slow frame sees the press when the mouse has moved on: what it was over in the last one has been pressed.
      if (!over_) point(picture, mouse);
      held_ = over_;
      if (held_) anchor_ = box_.middle(*held_);
    } else if (held_ && mouse.dragged) {
      drag(scene, picture, mouse.position);
    }
    const bool clicked = held_ && mouse.clicked;
    if (!down) {
      if (held_) keep(session);
      held_.reset();
      over_.reset();
      if (mouse.hovered && !clicked) point(picture, mouse);
    }
    const std::optional<int> active = down ? held_ : over_;
    drawEdges(picture, box_);
    drawHandles(picture, active);
    if (active) {
      ImGui::SetMouseCursor(ImGuiMouseCursor_Hand);
      ImGui::SetTooltip("%s: %.4g", kFaceNames[static_cast<size_t>(*active)], box_.middle(*active)[*active % 3]);
    }
    return active || clicked;
  }

 private:
  Box box_{};                       ///< as it is drawn; of what is dragged the setting follows when it is let go
  std::optional<int> held_, over_;  ///< face by the pressed button; under the mouse in the last frame
  glm::vec2 overAt_{0};             ///< where the mouse was then
  glm::dvec3 anchor_{0};            ///< where the handle was when it was taken

  bool release() {
    held_.reset();
    over_.reset();
    return false;
  }

  void point(const Picture& picture, const PictureMouse& mouse) {
    over_.reset();
    overAt_ = mouse.position;
    float nearest = 1.6f * handleRadius();
    for (int face = 0; face < kFaces; ++face) {
      const std::optional<glm::vec2> at = picture.project(box_.middle(face));
      if (!at || glm::distance(*at, mouse.position) >= nearest) continue;
      nearest = glm::distance(*at, mouse.position);
      over_ = face;
    }
  }

  /// The face goes no farther than the scene does, nor past the one opposite.
  void drag(const Scene& scene, const Picture& picture, glm::vec2 mouse) {
    const int axis = *held_ % 3;
    const std::optional<glm::dvec3> to = movedAlongAxis(picture, anchor_, axis, overAt_, mouse);
    if (!to) return;
    const double low = scene.origin[axis] + double{scene.boundsMin[axis]},
                 high = scene.origin[axis] + double{scene.boundsMax[axis]}, thinnest = 1e-3 * (high - low);
    double &lo = box_.lo[axis], &hi = box_.hi[axis];
    if (*held_ < 3)
      lo = std::min(std::max((*to)[axis], low), hi - thinnest);
    else
      hi = std::max(std::min((*to)[axis], high), lo + thinnest);
  }

  /// With the scene, whose sidecar it is saved in, also where it was a setting until now.
  void keep(Session& session) const {
    session.edits.region = RegionBox{glm::vec3(box_.lo), glm::vec3(box_.hi)};
    session.edited.scene.region = {};
  }

  static void drawEdges(const Picture& picture, const Box& box) {
    ImDrawList& list = *ImGui::GetWindowDrawList();
    for (int from = 0; from < 8; ++from)
      for (int bit = 1; bit < 8; bit *= 2)
        if (!(from & bit))
          if (const auto edge = picture.project(box.corner(from), box.corner(from | bit)))
            drawHandleLine(list, edge->first, edge->second, ImGui::ColorConvertFloat4ToU32(theme::accent));
  }

  void drawHandles(const Picture& picture, std::optional<int> active) const {
    ImDrawList& list = *ImGui::GetWindowDrawList();
    ImGui::PushID("region");
    for (int face = 0; face < kFaces; ++face) {
      const std::optional<glm::vec2> at = picture.project(box_.middle(face));
      if (!at) continue;
      const bool hot = active == face;
      const float r = handleRadius() * (hot ? 1.25f : 1.0f);
      const glm::vec2 half(0.3f * r);
      ImGui::tellPlace(kFaceNames[static_cast<size_t>(face)], *at - half, *at + half, hot);
      list.AddCircleFilled(toImVec(*at), r + 1.5f, kHandleEdge);
      list.AddCircleFilled(toImVec(*at), r, kAxisColors[static_cast<size_t>(face % 3)]);
    }
    ImGui::PopID();
  }
};

}  // namespace

std::unique_ptr<Overlay> makeRegionOverlay() {
  return std::make_unique<RegionOverlay>();
}

}  // namespace irad
