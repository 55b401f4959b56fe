// The histogram of the view, and the ends of its range, which are dragged on it.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "ui/histogram.h"
#include "ui/imgui.h"
#include "ui/session.h"
#include "ui/theme.h"
#include "ui/widgets.h"
#include "ui/words.h"

namespace irad {
namespace {

constexpr std::array<ImU32, 4> kColors{IM_COL32(235, 80, 80, 140), IM_COL32(80, 200, 90, 140),
                                       IM_COL32(90, 130, 250, 140), IM_COL32(200, 200, 200, 200)};

/// Where the counts are drawn.
struct Plot {
  glm::vec2 low, high;  ///< corners, pixels
  const Histogram& histogram;
  float x(float value) const {
    return low.x + (value - histogram.low) / (histogram.high - histogram.low) * (high.x - low.x);
  }
  float value(float x) const {
    return histogram.low + (x - low.x) / (high.x - low.x) * (histogram.high - histogram.low);
  }
};

uint32_t largestCount(const Histogram& h, uint32_t firstChannel, uint32_t endChannel) {
  return *std::max_element(std::begin(h.counts) + firstChannel * HISTOGRAM_BINS,
                           std::begin(h.counts) + endChannel * HISTOGRAM_BINS);
}

void drawBars(const Plot& plot, uint32_t channel, uint32_t most) {
  ImDrawList& list = *ImGui::GetWindowDrawList();
  const float width = (plot.high.x - plot.low.x) / HISTOGRAM_BINS;
  for (uint32_t bin = 0; bin < HISTOGRAM_BINS; ++bin) {
    const uint32_t count = plot.histogram.counts[channel * HISTOGRAM_BINS + bin];
    if (count == 0) continue;
    // A single pixel is seen, too.
    const float share = std::log2(1.0f + static_cast<float>(count)) / std::log2(1.0f + static_cast<float>(most));
    const float left = plot.low.x + width * static_cast<float>(bin);
    const float top = plot.high.y - std::max(share * (plot.high.y - plot.low.y), 1.0f);
    list.AddRectFilled({left, top}, {left + std::max(width, 1.0f), plot.high.y}, kColors[channel]);
  }
}

/// The bin under the mouse.
void readBin(const Plot& plot, bool one, bool luminance) {
  const float share = (ImGui::GetMousePos().x - plot.low.x) / (plot.high.x - plot.low.x);
  const auto bin = static_cast<uint32_t>(
      std::clamp(share * static_cast<float>(HISTOGRAM_BINS), 0.0f, static_cast<float>(HISTOGRAM_BINS - 1)));
  const Histogram& h = plot.histogram;
  const float width = (h.high - h.low) / HISTOGRAM_BINS, from = h.low + width * static_cast<float>(bin);
  std::string text = fmt::format("{:.4g} to {:.4g}", from, from + width);
  const auto count = [&](uint32_t channel) { return h.counts[channel * HISTOGRAM_BINS + bin]; };
  text += one || luminance ? "\n" + counted(count(3), "pixel")
                           : fmt::format("\npixels: red {}, green {}, blue {}", withThousands(count(0)),
                                         withThousands(count(1)), withThousands(count(2)));
  ImGui::SetTooltip("%s", text.c_str());
}

using End = ShownHistogram::End;

/// An end of the range as a line.
void drawEnd(const char* name, const Plot& plot, float value, bool upper, bool chosen) {
  const float em = ImGui::GetFontSize(), x = std::clamp(plot.x(value), plot.low.x, plot.high.x);
  const ImU32 color = ImGui::GetColorU32(chosen ? theme::accent : theme::text);
  ImDrawList& list = *ImGui::GetWindowDrawList();
  list.AddLine({x, plot.low.y}, {x, plot.high.y}, color, std::max(1.0f, em / 9));
  const float side = upper ? 0.45f * em : -0.45f * em;
  list.AddTriangleFilled({x, plot.low.y}, {x + side, plot.low.y}, {x, plot.low.y + 0.6f * em}, color);
  ImGui::SetCursorScreenPos({x - 2, plot.low.y});
  ImGui::Dummy({4, plot.high.y - plot.low.y});
  ImGui::tellControl(name, chosen);
}

/// The end that a place is on, the nearer one.
End endAt(const Plot& plot, const ViewRange& range, float mouse) {
  const float reach = 0.6f * ImGui::GetFontSize();
  const auto beside = [&](float value) { return mouse - std::clamp(plot.x(value), plot.low.x, plot.high.x); };
  const float low = beside(range.low), high = beside(range.high);
  // Where both are in one place, each is taken from its own side.
  const bool upper = std::abs(high) < std::abs(low) || (high == low && high > 0);
  const float off = upper ? high : low;
  if (std::abs(off) > reach) return {};
  return {upper ? End::Which::High : End::Which::Low, mouse, off};
}

/// The ends of the range, which the mouse takes along; view.range becomes manual, from what was shown. True where the
/// mouse is on one.
bool drawRange(Session& session, const ViewInfo& info, const Plot& plot) {
  ShownHistogram& shown = session.histogram;
  const ViewRange range = *session.range;
  ImGui::SetCursorScreenPos({plot.low.x - 8, plot.low.y});
  ImGui::InvisibleButton("ends", {plot.high.x - plot.low.x + 16, plot.high.y - plot.low.y});
  const bool active = ImGui::IsItemActive(), hovered = ImGui::IsItemHovered();
  const float mouse = ImGui::GetMousePos().x;
  if (ImGui::IsItemActivated()) {
    // A slow frame sees the press when the mouse has moved on: what it was on in the last one has been pressed.
    shown.held = shown.over.which != End::Which::None ? shown.over : endAt(plot, range, mouse);
  } else if (!active) {
    shown.held = {};
    shown.over = hovered ? endAt(plot, range, mouse) : End{};
  }
  const End::Which chosen = active ? shown.held.which : shown.over.which;
  drawEnd("low", plot, range.low, false, chosen == End::Which::Low);
  drawEnd("high", plot, range.high, true, chosen == End::Which::High);
  if (chosen == End::Which::None) return false;
  ImGui::SetMouseCursor(ImGuiMouseCursor_ResizeEW);
  if (!active) {
    ImGui::SetTooltip("%s", chosen == End::Which::Low ? "Drag: the value that the color map begins with (view.low)"
                                                      : "Drag: the value that the color map ends with (view.high)");
    return true;
  }
  shown.axis = glm::vec2(plot.histogram.low, plot.histogram.high);
  if (mouse == shown.held.mouse) return true;
  shown.held.mouse = -1;  // from now on it follows, back to where it was, too
  const float x = std::clamp(mouse - shown.held.beside, plot.low.x, plot.high.x);
  const float to = std::clamp(plot.value(x), -1e6f, 1e6f);
  const bool upper = chosen == End::Which::High;
  ViewSettings& view = session.edited.view;
  if (view.range != RangeMode::manual) {
    view.low = std::clamp(range.low, -1e6f, 1e6f);
    view.high = std::clamp(range.high, -1e6f, 1e6f);
    view.range = RangeMode::manual;
  }
  if (info.kind == VIEW_KIND_SIGNED) {  // even about 0
    view.high = std::max(upper ? to : -to, 0.0f);
    view.low = -view.high;
  } else {
    (upper ? view.high : view.low) = to;
  }
  return true;
}

}  // namespace

void drawHistogram(Session& session, const ViewInfo& info) {
  ShownHistogram& shown = session.histogram;
  shown.axis.reset();
  if (!hasHistogram(info)) return ImGui::TextColored(theme::dim, "Seeds have no order to be counted in.");
  shown.wanted = true;
  const bool difference = session.showsDifference(), one = info.hasRange() || difference;
  ImGui::PushID("histogram");
  if (!one) {
    bool& luminance = shown.luminance;
    if (ImGui::RadioButton("channels", !luminance)) luminance = false;
    helpTooltip("Red, green and blue, one over the other");
    ImGui::SameLine();
    if (ImGui::RadioButton("luminance", luminance)) luminance = true;
    helpTooltip("Of red, green and blue together, as bright as they look");
  }
  const float em = ImGui::GetFontSize(), width = ImGui::GetContentRegionAvail().x, height = 6 * em;
  const ImVec2 at = ImGui::GetCursorScreenPos();
  ImGui::Dummy({width, height});
  const bool hovered = ImGui::IsItemHovered();
  ImGui::tellControl("plot", shown.counts.has_value());
  const ImVec2 below = ImGui::GetCursorScreenPos();
  const float margin = 0.6f * em;  // for the grips
  ImDrawList& list = *ImGui::GetWindowDrawList();
  list.AddRectFilled({at.x, at.y}, {at.x + width, at.y + height}, ImGui::GetColorU32(ImGuiCol_FrameBg));
  if (!shown.counts || shown.counts->view != session.view || shown.counts->difference != difference) {
    ImGui::PopID();
    return;
  }
  const Plot plot{{at.x + margin, at.y}, {at.x + width - margin, at.y + height}, shown.counts->histogram};
  const bool luminance = !one && shown.luminance;
  const uint32_t first = one || luminance ? 3 : 0, end = one || luminance ? 4 : 3;
  const uint32_t most = std::max(largestCount(plot.histogram, first, end), 1u);
  for (uint32_t channel = first; channel < end; ++channel) drawBars(plot, channel, most);
  const bool ends = info.hasRange() && !difference && session.range && session.rangeView == session.view &&
                    !session.rangeOfDifference && drawRange(session, info, plot);
  if (hovered && !ends) readBin(plot, one, luminance);

  ImGui::SetCursorScreenPos(below);
  const float start = ImGui::GetCursorPosX();
  const std::string low = fmt::format("{:.4g}", plot.histogram.low), high = fmt::format("{:.4g}", plot.histogram.high);
  ImGui::TextColored(theme::dim, "%s", low.c_str());
  helpTooltip(
      "Values from left to right in bins of one width; how often they occur from bottom to top, on a logarithmic "
      "scale.");
  ImGui::SameLine(start + std::max(width - ImGui::CalcTextSize(high.c_str()).x, 0.0f));
  ImGui::TextColored(theme::dim, "%s", high.c_str());
  if (plot.histogram.below + plot.histogram.above > 0)
    ImGui::TextColored(
        theme::dim, "%s",
        clipped("beyond: " + counted(plot.histogram.below + plot.histogram.above, "pixel"), width).c_str());
  ImGui::PopID();
}

}  // namespace irad
