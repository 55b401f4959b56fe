// Where things are in the window: a bar on top, a column left and right, a strip below, the viewport in the middle. A
// pure function of the window's size, so that nothing overlaps at any size.
#pragma once

#include <glm/glm.hpp>

namespace irad {

struct Rect {
  glm::vec2 position{0}, size{0};  ///< pixels
};

/// Widths of the columns and height of the strip as the user has dragged them, in units; 0: chosen from the window's
/// size.
struct PanelSizes {
  float left = 0, right = 0, bottom = 0;
  bool operator==(const PanelSizes&) const = default;
};

struct Layout {
  Rect bar, left, right, bottom, viewport;
};

/// `scale`: pixels per unit. `hidden`: the viewport takes the whole window. Whatever `sizes` asks for, the viewport
/// keeps a fifth of the window each way.
Layout layout(glm::uvec2 window, float scale, bool hidden, const PanelSizes& sizes = {});

/// The edges between the viewport and the panels: drags change `sizes`, a double click gives the choice back.
void dragEdges(const Layout& layout, float scale, PanelSizes& sizes);

}  // namespace irad
