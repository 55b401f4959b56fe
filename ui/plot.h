// Lines over a common axis, with ticks and a reading under the mouse.
#pragma once

#include <functional>
#include <glm/glm.hpp>
#include <optional>
#include <span>
#include <string>

namespace irad {

struct PlotLine {
  std::string name;
  uint32_t color = 0;        ///< ImU32
  std::span<const float> y;  ///< a value per x; NaN where there is none
};

struct PlotAxes {
  bool logarithmic = false;                 ///< values <= 0 lie at the lower edge
  std::span<const float> x;                 ///< ascending, one for every value
  std::function<std::string(float)> xText;  ///< at both ends, and in the reading
  std::function<std::string(float)> yText;  ///< ticks and values, with their unit
  std::optional<float> mark;                ///< a dashed line across
  bool ignoresOutlier = false;  ///< one place whose values would leave no room for the others is cut, and said so
  size_t bridge = 1;            ///< values at most this many places apart are joined by a line
};

/// The largest value of the one place that exceeds all others by a factor of 3 or more; none where there is no such
/// place, or there are fewer than 8 with a value.
std::optional<float> outlier(std::span<const PlotLine> lines);

/// Draws into the next `size` pixels. Where the mouse is over it, its nearest x is marked and read in a tooltip, and
/// its index returned.
std::optional<size_t> plot(glm::vec2 size, std::span<const PlotLine> lines, const PlotAxes& axes);

/// Colours that can be told apart, with normal and with colour-deficient sight (Okabe and Ito 2008), then again
/// paler.
uint32_t seriesColor(size_t index);

}  // namespace irad
