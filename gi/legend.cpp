#include "gi/legend.h"

#include <fmt/format.h>

#include <algorithm>

#include "gi/views/views.h"
#include "renderer/base/image_io.h"
#include "renderer/base/number_text.h"
#include "renderer/base/ticks.h"
#include "shaders/shared/color_map.h"

namespace irad {

Legend makeLegend(const Quantity& quantity, ColorMap map, const ViewRange& range) {
  Legend legend;
  legend.title = quantity.name + (quantity.unit.empty() ? "" : " (" + prettyUnit(quantity.unit) + ")");
  legend.map = map;
  std::vector<double> values = ticks(range.low, range.high, 5);
  if (range.low == range.high) values = {range.low};
  for (const double value : values)
    legend.ticks.push_back({colorMapPosition(static_cast<float>(value), range.low, range.high), shortNumber(value)});
  const auto mark = [&](uint32_t count, const char* what) {
    if (count > 0) legend.marks += fmt::format("{}{} {}", legend.marks.empty() ? "" : ", ", withThousands(count), what);
  };
  mark(range.nan, "NaN (red)");
  mark(range.infinite, "infinite (green)");
  mark(range.negative, "negative (blue)");
  return legend;
}

void drawLegend(const Legend& legend, glm::uvec2 size, std::span<glm::u8vec4> pixels) {
  constexpr int kText = 14, kLine = 19, kPad = 7, kMargin = 14, kWidest = 280;
  const int width = std::min(kWidest, static_cast<int>(size.x) - 4 * kMargin);
  const int height = 2 * kLine + kText + 4 + (legend.marks.empty() ? 0 : kLine);
  if (width < 6 * kText || static_cast<int>(size.y) < height + 2 * kPad + 2 * kMargin) return;
  const glm::ivec2 inside = glm::ivec2(size) - kMargin - kPad - glm::ivec2(width, height);

  const auto pixel = [&](int x, int y) -> glm::u8vec4& {
    return pixels[static_cast<size_t>(y) * size.x + static_cast<size_t>(x)];
  };
  const auto fill = [&](glm::ivec2 low, glm::ivec2 extent, auto&& color) {
    for (int y = low.y; y < low.y + extent.y; ++y)
      for (int x = low.x; x < low.x + extent.x; ++x) pixel(x, y) = color(x - low.x, pixel(x, y));
  };
  // The picture shows a little through the ground.
  fill(inside - kPad, glm::ivec2(width, height) + 2 * kPad, [](int, const glm::u8vec4& under) {
    return glm::u8vec4(glm::mix(glm::vec3(under), glm::vec3(20, 20, 22), 0.84f), 255);
  });
  const int bar = inside.y + kLine;
  fill({inside.x, bar}, {width, kText}, [&](int x, const glm::u8vec4&) {
    const float t = (static_cast<float>(x) + 0.5f) / static_cast<float>(width);
    return glm::u8vec4(encodeSrgb(colorMap(legend.map, t)) * 255.0f + 0.5f, 255);
  });

  constexpr glm::u8vec4 kInk{219, 222, 227, 255}, kWarning{242, 196, 92, 255};
  drawText(size, pixels, {inside.x, inside.y}, TextAlign::Left, kText, legend.title, kInk);
  for (const Legend::Tick& tick : legend.ticks) {
    const int x = inside.x + static_cast<int>(tick.at * static_cast<float>(width - 1));
    fill({x, bar + kText}, {1, 4}, [&](int, const glm::u8vec4&) { return kInk; });
    const TextAlign align = tick.at < 0.05f ? TextAlign::Left : tick.at > 0.95f ? TextAlign::Right : TextAlign::Middle;
    drawText(size, pixels, {x, bar + kText + 4}, align, kText, tick.label, kInk);
  }
  drawText(size, pixels, {inside.x, bar + kText + 4 + kLine}, TextAlign::Left, kText, legend.marks, kWarning);
}

}  // namespace irad
