// Where things are in the window: a bar on top, a column left and right, a strip below, the viewport in the middle. A
// pure function of the window's size and of what is folded, so that nothing overlaps at any size.
#pragma once

#include <glm/glm.hpp>
#include <set>
#include <string>

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

/// The titles under which columns are kept in Preferences::folded, as panels are under theirs.
inline constexpr const char *kLeftColumn = "Left column", *kRightColumn = "Right column";

/// What is folded to its edge of the window. The viewport has the room: of a column nothing is left but a handle on the
/// picture's edge, of the strip its header.
struct Folding {
  bool left = false, right = false, strip = false;
};

/// What the window shows: the panels; the picture below the menu bar (Tab); the picture and nothing else (F2).
enum class Filling { Panels, Picture, PictureAlone };

struct Layout {
  Rect bar, left, right, bottom, viewport;
};

/// `scale`: pixels per unit. Whatever `sizes` asks for, the viewport keeps a fifth of the window each way. With the
/// sizes of a first start and the strip folded it has more than half of a window of 1280 x 720 or larger, at scale 1.
Layout layout(glm::uvec2 window, float scale, Filling filling, const PanelSizes& sizes = {},
              const Folding& folding = {});

/// The edges between the viewport and the panels: drags change `sizes`, a double click gives the choice back. On each
/// column's a handle that folds it and unfolds it (kLeftColumn, kRightColumn in `folded`).
void drawEdges(const Layout& layout, float scale, PanelSizes& sizes, std::set<std::string>& folded);

}  // namespace irad
