#include "ui/color_bar.h"

namespace irad {

ImU32 mapColor(ColorMap map, float t, float alpha) {
  const glm::vec4 c = glm::clamp(glm::vec4(encodeSrgb(colorMap(map, t)), alpha), 0.0f, 1.0f) * 255.0f + 0.5f;
  return IM_COL32(static_cast<int>(c.x), static_cast<int>(c.y), static_cast<int>(c.z), static_cast<int>(c.w));
}

void drawColorBar(ImDrawList& list, glm::vec2 at, glm::vec2 size, ColorMap map) {
  constexpr int kSteps = 64;
  for (int i = 0; i < kSteps; ++i) {
    const float x0 = at.x + size.x * static_cast<float>(i) / kSteps,
                x1 = at.x + size.x * static_cast<float>(i + 1) / kSteps;
    list.AddRectFilled({x0, at.y}, {x1, at.y + size.y}, mapColor(map, (static_cast<float>(i) + 0.5f) / kSteps));
  }
}

}  // namespace irad
