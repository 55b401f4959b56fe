// The picture in the middle of the window: what is drawn over it, and the mouse on it.
#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "ui/layout.h"
#include "ui/session.h"

namespace irad {

class ImGuiLayer;

/// Where the picture is on the screen, and how the scene was projected onto it.
class Picture {
 public:
  /// `rect`: of the whole picture, of which `window` is in view.
  Picture(const Rect& rect, const Rect& window, const Scene& scene, const Camera& camera, glm::uvec2 size);

  const Rect& rect() const { return rect_; }
  const Rect& window() const { return window_; }
  /// What of the window is above the status line.
  Rect clear() const;
  /// Screen position of a point of the world; none behind the near plane.
  std::optional<glm::vec2> project(const glm::dvec3& world) const;
  /// Both ends of a segment, cut at the near plane; none where all of it is behind.
  std::optional<std::pair<glm::vec2, glm::vec2>> project(const glm::dvec3& from, const glm::dvec3& to) const;
  /// The world ray through a point of the screen: a point on the near plane, and the unit direction.
  std::pair<glm::dvec3, glm::dvec3> ray(glm::vec2 screen) const;
  /// The picture's pixel under a point of the screen.
  glm::uvec2 pixel(glm::vec2 screen) const;
  /// A pixel's corners on the screen.
  std::pair<glm::vec2, glm::vec2> area(glm::uvec2 pixel) const;

 private:
  glm::dvec4 clip(const glm::dvec3& world) const;
  glm::vec2 onScreen(const glm::dvec4& clip) const;
  Rect rect_, window_;
  glm::uvec2 size_;
  glm::dvec3 origin_;          ///< the scene's, world
  glm::dmat4 viewProjection_;  ///< local space (relative to the origin) to clip space
};

/// The mouse over the picture.
struct PictureMouse {
  glm::vec2 position{0};  ///< screen
  glm::vec2 delta{0};     ///< since the last frame, screen
  bool hovered = false;   ///< it is over the picture and over no panel, or a button pressed there is held
  bool pressed = false;   ///< the left button went down
  bool dragged = false;   ///< it is held and has moved since by more than a hand trembles
  bool clicked = false;   ///< it came up without having been dragged
  bool shift = false, control = false;
};

/// Something drawn over the picture with ImGui's draw lists: one file in ui/overlays/, one line in the list below.
class Overlay {
 public:
  virtual ~Overlay() = default;
  /// True where it takes the mouse: neither the camera nor the overlays after it see the mouse then.
  virtual bool draw(Session& session, const Picture& picture, const PictureMouse& mouse) = 0;
};

// In the order in which they are drawn and offered the mouse. X(Name) stands for makeNameOverlay() in ui/overlays/.
#define IRAD_OVERLAYS(X) \
  X(PixelValues)         \
  X(Lights)              \
  X(Region)              \
  X(Row)                 \
  X(Legend)              \
  X(NoLight)             \
  X(Pointing)

#define IRAD_DECLARE_OVERLAY(name) std::unique_ptr<Overlay> make##name##Overlay();
IRAD_OVERLAYS(IRAD_DECLARE_OVERLAY)
#undef IRAD_DECLARE_OVERLAY

/// Height of the status line (ui/overlays/pointing.cpp), of a viewport of this width, pixels: one or two lines.
float statusLine();
float statusHeight(float width);
/// Whether it is at the picture's upper edge, since the mouse is at the lower one.
bool statusAbove(const Rect& window, float mouseY);

class Viewport {
 public:
  Viewport();
  /// The picture in session.targets, what the overlays draw on it; drags that none of them takes turn the camera.
  void draw(Session& session, ImGuiLayer& layer, const Rect& where);

 private:
  PictureMouse mouse();
  std::vector<std::unique_ptr<Overlay>> overlays_;
  bool dragsSplit_ = false;
  bool moved_ = false;       ///< the left button's drag has begun
  glm::vec2 lastMouse_{0};   ///< where the mouse was over the picture before a button was pressed
  Overlay* held_ = nullptr;  ///< has the mouse until the button comes up
};

}  // namespace irad
