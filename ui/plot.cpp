#include "ui/plot.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "renderer/base/ticks.h"
#include "ui/imgui.h"
#include "ui/theme.h"

namespace irad {
namespace {

constexpr float kDecadesShown = 12;

/// From values to pixels.
struct Scale {
  ImVec2 low, high;  ///< corners of the field
  float x0 = 0, x1 = 1, y0 = 0, y1 = 1;
  bool logarithmic = false;

  float x(float value) const { return low.x + (value - x0) / (x1 - x0) * (high.x - low.x); }
  float y(float value) const {
    const float v = logarithmic ? std::log10(std::max(value, 1e-37f)) : value;
    return high.y - std::clamp((v - y0) / (y1 - y0), 0.0f, 1.0f) * (high.y - low.y);
  }
};

/// The largest value of each place, NaN where there is none.
std::vector<float> largest(std::span<const PlotLine> lines) {
  std::vector<float> most;
  for (const PlotLine& line : lines) {
    most.resize(std::max(most.size(), line.y.size()), std::numeric_limits<float>::quiet_NaN());
    for (size_t i = 0; i < line.y.size(); ++i)
      if (!std::isnan(line.y[i]) && !(most[i] >= line.y[i])) most[i] = line.y[i];
  }
  return most;
}

/// Values from 0, or whole decades around what is above 0. `beyond`: values that are not made room for.
void fitValues(Scale& scale, std::span<const PlotLine> lines, std::optional<float> mark, std::optional<float> beyond) {
  float least = std::numeric_limits<float>::infinity(), most = 0;
  // All values at the outlier's place are below it, and at other places below a third of it.
  const float end = beyond ? *beyond / 3 : std::numeric_limits<float>::infinity();
  const auto take = [&](float v) {
    if (!std::isfinite(v) || v <= 0 || v > end) return;
    least = std::min(least, v);
    most = std::max(most, v);
  };
  for (const PlotLine& line : lines) std::for_each(line.y.begin(), line.y.end(), take);
  if (mark) take(*mark);
  if (most <= 0) least = most = 1;
  if (scale.logarithmic) {
    scale.y1 = std::ceil(std::log10(most));
    scale.y0 = std::max(std::floor(std::log10(least)), scale.y1 - kDecadesShown);
    if (scale.y0 == scale.y1) scale.y0 -= 1;
  } else {
    scale.y0 = 0;
    scale.y1 = 1.05f * most;
  }
}

std::vector<float> valueTicks(const Scale& scale, int most) {
  std::vector<float> out;
  if (!scale.logarithmic) {
    for (const double t : ticks(scale.y0, scale.y1, std::max(most, 2))) out.push_back(static_cast<float>(t));
    return out;
  }
  const int decades = static_cast<int>(scale.y1 - scale.y0), step = std::max(1, (decades + most - 1) / most);
  for (int d = 0; d <= decades; d += step) out.push_back(std::pow(10.0f, scale.y0 + static_cast<float>(d)));
  return out;
}

void drawLine(ImDrawList& list, const Scale& scale, const PlotLine& line, const PlotAxes& axes) {
  std::vector<ImVec2> run;
  size_t last = 0;
  const auto finish = [&] {
    if (run.size() == 1) list.AddCircleFilled(run[0], 1.5f, line.color);
    if (run.size() > 1) list.AddPolyline(run.data(), static_cast<int>(run.size()), line.color, 0, 1.25f);
    run.clear();
  };
  for (size_t i = 0; i < line.y.size(); ++i) {
    if (std::isnan(line.y[i])) continue;
    if (!run.empty() && i - last > axes.bridge) finish();
    run.push_back({scale.x(axes.x[i]), scale.y(line.y[i])});
    last = i;
  }
  finish();
}

void drawMark(ImDrawList& list, const Scale& scale, float value) {
  const float y = scale.y(value), dash = 4;
  for (float x = scale.low.x; x < scale.high.x; x += 2 * dash)
    list.AddLine({x, y}, {std::min(x + dash, scale.high.x), y}, ImGui::GetColorU32(theme::dim));
}

void read(size_t at, std::span<const PlotLine> lines, const PlotAxes& axes) {
  std::vector<std::pair<ImU32, std::string>> text{{ImGui::GetColorU32(theme::dim), axes.xText(axes.x[at])}};
  for (const PlotLine& line : lines)
    if (!std::isnan(line.y[at]))
      text.emplace_back(line.color, fmt::format("{}  {}", axes.yText(line.y[at]), line.name));
  // Sized by hand: otherwise it keeps the size of the text before, and cuts a longer one.
  const ImGuiStyle& style = ImGui::GetStyle();
  ImVec2 size{0, static_cast<float>(text.size()) * ImGui::GetTextLineHeightWithSpacing() - style.ItemSpacing.y};
  for (const auto& [color, row] : text) size.x = std::max(size.x, ImGui::CalcTextSize(row.c_str()).x);
  ImGui::SetNextWindowSize({size.x + 2 * style.WindowPadding.x, size.y + 2 * style.WindowPadding.y});
  ImGui::BeginTooltip();
  for (const auto& [color, row] : text) {
    ImGui::PushStyleColor(ImGuiCol_Text, color);
    ImGui::TextUnformatted(row.c_str());
    ImGui::PopStyleColor();
  }
  ImGui::EndTooltip();
}

}  // namespace

std::optional<float> outlier(std::span<const PlotLine> lines) {
  std::vector<float> values;
  for (const float v : largest(lines))
    if (std::isfinite(v)) values.push_back(v);
  if (values.size() < 8) return std::nullopt;
  std::partial_sort(values.begin(), values.begin() + 2, values.end(), std::greater());
  return values[0] >= 3 * values[1] && values[1] > 0 ? std::optional(values[0]) : std::nullopt;
}

std::optional<size_t> plot(glm::vec2 size, std::span<const PlotLine> lines, const PlotAxes& axes) {
  const ImVec2 corner = ImGui::GetCursorScreenPos();
  ImGui::Dummy({size.x, size.y});
  const bool hovered = ImGui::IsItemHovered();
  const float text = ImGui::GetTextLineHeight(), pad = 0.3f * text;
  if (size.x < 8 * text || size.y < 3 * text || axes.x.empty()) return std::nullopt;
  ImDrawList& list = *ImGui::GetWindowDrawList();
  const ImU32 dim = ImGui::GetColorU32(theme::dim), grid = ImGui::GetColorU32(ImGuiCol_Border);

  Scale scale;
  scale.logarithmic = axes.logarithmic;
  const std::optional<float> beyond =
      axes.ignoresOutlier && !axes.logarithmic ? outlier(lines) : std::optional<float>();
  fitValues(scale, lines, axes.mark, beyond);
  scale.x0 = axes.x.front();
  scale.x1 = std::max(axes.x.back(), scale.x0 + 1e-6f);
  scale.low.y = corner.y + 0.5f * text;
  scale.high = {corner.x + size.x - pad, corner.y + size.y - text - pad};

  // The values' ticks, in a margin as wide as the widest of them.
  const auto labels = valueTicks(scale, std::max(1, static_cast<int>((scale.high.y - scale.low.y) / (1.5f * text))));
  float margin = 0;
  for (const float v : labels) margin = std::max(margin, ImGui::CalcTextSize(axes.yText(v).c_str()).x);
  scale.low.x = corner.x + margin + pad;
  list.AddRectFilled(scale.low, scale.high, ImGui::GetColorU32(ImGuiCol_FrameBg));
  for (const float v : labels) {
    const std::string label = axes.yText(v);
    const float y = scale.y(v);
    list.AddLine({scale.low.x, y}, {scale.high.x, y}, grid);
    list.AddText({scale.low.x - pad - ImGui::CalcTextSize(label.c_str()).x, y - 0.5f * text}, dim, label.c_str());
  }
  const std::string first = axes.xText(axes.x.front()), last = axes.xText(axes.x.back());
  list.AddText({scale.low.x, scale.high.y + 0.5f * pad}, dim, first.c_str());
  list.AddText({scale.high.x - ImGui::CalcTextSize(last.c_str()).x, scale.high.y + 0.5f * pad}, dim, last.c_str());

  if (axes.mark) drawMark(list, scale, *axes.mark);
  for (const PlotLine& line : lines) drawLine(list, scale, line, axes);
  if (beyond) {
    const std::string said = fmt::format("one peak of {} is cut", axes.yText(*beyond));
    const float x = scale.high.x - pad - ImGui::CalcTextSize(said.c_str()).x;
    const glm::vec2 at{std::max(x, scale.low.x + pad), scale.low.y};
    list.AddText({at.x, at.y}, ImGui::GetColorU32(theme::warning), said.c_str());
    ImGui::tellPlace(said.c_str(), at, {scale.high.x - pad, at.y + text});
  }

  const ImVec2 mouse = ImGui::GetMousePos();
  if (!hovered || mouse.x < scale.low.x || mouse.x > scale.high.x || mouse.y > scale.high.y) return std::nullopt;
  const float wanted = scale.x0 + (mouse.x - scale.low.x) / (scale.high.x - scale.low.x) * (scale.x1 - scale.x0);
  const auto above = static_cast<size_t>(std::lower_bound(axes.x.begin(), axes.x.end(), wanted) - axes.x.begin());
  size_t at = std::min(above, axes.x.size() - 1);
  if (at > 0 && wanted - axes.x[at - 1] < axes.x[at] - wanted) --at;
  const float x = scale.x(axes.x[at]);
  list.AddLine({x, scale.low.y}, {x, scale.high.y}, ImGui::GetColorU32(theme::text));
  read(at, lines, axes);
  return at;
}

uint32_t seriesColor(size_t index) {
  constexpr std::array<ImU32, 7> colors{IM_COL32(230, 159, 0, 255),   IM_COL32(86, 180, 233, 255),
                                        IM_COL32(0, 158, 115, 255),   IM_COL32(240, 228, 66, 255),
                                        IM_COL32(204, 121, 167, 255), IM_COL32(213, 94, 0, 255),
                                        IM_COL32(90, 140, 230, 255)};
  ImVec4 color = ImGui::ColorConvertU32ToFloat4(colors[index % colors.size()]);
  const float white = index / colors.size() % 2 == 0 ? 0.0f : 0.5f;
  for (float* c : {&color.x, &color.y, &color.z}) *c += white * (1 - *c);
  return ImGui::ColorConvertFloat4ToU32(color);
}

}  // namespace irad
