#include "ui/zoom.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace irad {
namespace {

constexpr std::array<float, 14> kScales{1, 2, 3, 4, 6, 8, 12, 16, 24, 32, 48, 64, 96, 128};

}  // namespace

Rect Zoom::picture(const Rect& window) const {
  const glm::vec2 size = window.size * scale;
  return {window.position - glm::round(corner * size), size};
}

void Zoom::turn(const Rect& window, glm::vec2 at, float steps) {
  const auto now = std::find(kScales.begin(), kScales.end(), scale) - kScales.begin();
  const auto wanted = now + static_cast<ptrdiff_t>(steps > 0 ? std::ceil(steps) : std::floor(steps));
  const glm::vec2 under = corner + (at - window.position) / (window.size * scale);
  scale = kScales[static_cast<size_t>(std::clamp<ptrdiff_t>(wanted, 0, kScales.size() - 1))];
  corner = under - (at - window.position) / (window.size * scale);
  clamp();
}

void Zoom::pan(const Rect& window, glm::vec2 by) {
  corner -= by / (window.size * scale);
  clamp();
}

void Zoom::clamp() {
  corner = glm::clamp(corner, glm::vec2(0), glm::vec2(1 - 1 / scale));
}

}  // namespace irad
