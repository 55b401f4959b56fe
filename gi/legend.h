// The legend of a picture with a range: what it says, for the window to draw, and drawn into a picture.
#pragma once

#include <glm/glm.hpp>
#include <span>
#include <string>
#include <vector>

#include "shaders/shared/color_map.h"
#include "shaders/shared/view.h"

namespace irad {

struct Quantity;

struct Legend {
  std::string title;  ///< "Depth (m)"
  ColorMap map{};
  struct Tick {
    float at;  ///< share of the bar's length
    std::string label;
  };
  std::vector<Tick> ticks;
  std::string marks;  ///< how many pixels have no place in the map: "12 NaN (red)"; empty: none
};
Legend makeLegend(const Quantity& quantity, ColorMap map, const ViewRange& range);

/// Into the lower right corner of a display picture, top row first: text in the panels' typeface. Pictures too small
/// for anything legible (below 144 x 96) stay as they are. WorkError in builds without OpenImageIO.
void drawLegend(const Legend& legend, glm::uvec2 size, std::span<glm::u8vec4> pixels);

}  // namespace irad
