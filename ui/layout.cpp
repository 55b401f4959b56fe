#include "ui/layout.h"

#include <algorithm>
#include <cmath>

namespace irad {

Layout layout(glm::uvec2 window, float scale, bool hidden) {
  const glm::vec2 size(window);
  Layout l;
  if (hidden) {
    l.viewport = {{0, 0}, size};
    return l;
  }
  // A share of the window within readable bounds, and never more than a third: the viewport keeps the rest.
  const auto share = [](float whole, float part, float least, float most) {
    return std::floor(std::min(std::clamp(whole * part, least, most), whole / 3.0f));
  };
  const float bar = std::min(std::floor(30.0f * scale), size.y / 3.0f);
  const float left = share(size.x, 0.26f, 300.0f * scale, 400.0f * scale);
  const float right = share(size.x, 0.22f, 260.0f * scale, 340.0f * scale);
  const float bottom = share(size.y, 0.26f, 170.0f * scale, 320.0f * scale);
  const float middle = size.x - left - right;
  l.bar = {{0, 0}, {size.x, bar}};
  l.left = {{0, bar}, {left, size.y - bar}};
  l.right = {{size.x - right, bar}, {right, size.y - bar}};
  l.bottom = {{left, size.y - bottom}, {middle, bottom}};
  l.viewport = {{left, bar}, {middle, size.y - bar - bottom}};
  return l;
}

}  // namespace irad
