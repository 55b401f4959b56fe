// How large the picture's pixels are shown. Nothing is rendered anew for it.
#pragma once

#include "ui/layout.h"

namespace irad {

struct Zoom {
  float scale = 1;      ///< pixels of the screen per pixel of the picture, one of a few whole numbers
  glm::vec2 corner{0};  ///< what is shown at the viewport's upper left, as a share of the picture
  bool on() const { return scale > 1; }

  /// Where the whole picture lies that `window` shows a part of; whole pixels.
  Rect picture(const Rect& window) const;
  /// So many steps in (> 0) or out; the picture stays where it is under `at`, a point of the screen.
  void turn(const Rect& window, glm::vec2 at, float steps);
  /// With the mouse, pixels of the screen.
  void pan(const Rect& window, glm::vec2 by);

 private:
  void clamp();
};

}  // namespace irad
