// A study's points: error against cost, both logarithmic, with the front; a point is read under the mouse and taken by
// a click.
#pragma once

#include <glm/glm.hpp>
#include <optional>
#include <string>
#include <vector>

#include "gi/study/front.h"

namespace irad {

struct FrontPlot {
  struct Point {
    size_t number;  ///< of the study
    CostAndError at;
    double half = 0;   ///< of the error's interval; 0: none is known
    std::string text;  ///< what is read under the mouse
    bool onFront = false;
  };
  std::vector<Point> points;   ///< cost and error > 0
  std::optional<size_t> here;  ///< number of the point of the settings as they are
  bool exactly = true;         ///< or the nearest
  std::string costUnit;        ///< "ms"
};
struct FrontAnswer {
  std::optional<size_t> hovered, clicked;  ///< numbers of points
};
/// Draws into the next `size` pixels. Points are controls: "point 7".
FrontAnswer frontPlot(glm::vec2 size, const FrontPlot& plot);

}  // namespace irad
