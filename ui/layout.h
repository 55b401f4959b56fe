// Where things are in the window: a bar on top, a column left and right, a strip below, the viewport in the middle. A
// pure function of the window's size, so that nothing overlaps at any size.
#pragma once

#include <glm/glm.hpp>

namespace irad {

struct Rect {
  glm::vec2 position{0}, size{0};  ///< pixels
};

struct Layout {
  Rect bar, left, right, bottom, viewport;
};

/// `scale`: pixels per unit. `hidden`: the viewport takes the whole window.
Layout layout(glm::uvec2 window, float scale, bool hidden);

}  // namespace irad
