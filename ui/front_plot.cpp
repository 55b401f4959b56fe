#include "ui/front_plot.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "renderer/base/number_text.h"
#include "ui/imgui.h"
#include "ui/theme.h"
#include "ui/widgets.h"

namespace irad {
namespace {

/// From values to pixels along one axis, by logarithms.
struct LogAxis {
  double low = 1, high = 10;  ///< values
  float from = 0, to = 1;     ///< pixels
  float at(double value) const {
    const double share = (std::log(value) - std::log(low)) / (std::log(high) - std::log(low));
    return from + static_cast<float>(std::clamp(share, 0.0, 1.0)) * (to - from);
  }
  /// With some room around the values.
  static LogAxis around(double least, double most) {
    const double room = std::max(std::log(most / least) * 0.08, 0.1);
    return {least * std::exp(-room), most * std::exp(room)};
  }
  /// 1, 2, 5 times powers of ten; whole powers alone where there would be more than `most`.
  std::vector<double> ticks(int most) const {
    std::vector<double> out;
    for (const std::vector<double>& steps : {std::vector<double>{1, 2, 5}, {1, 3}, {1}}) {
      out.clear();
      for (int e = static_cast<int>(std::floor(std::log10(low))); std::pow(10.0, e) <= high; ++e)
        for (const double step : steps)
          if (const double v = step * std::pow(10.0, e); v >= low && v <= high) out.push_back(v);
      if (static_cast<int>(out.size()) <= most) break;
    }
    return out;
  }
};

std::string tickText(double value) {
  return value >= 1 ? fmt::format("{:.0f}", value) : fmt::format("{:.3g}", value);
}

void tooltip(const std::string& text) {
  ImGui::BeginTooltip();
  ImGui::PushTextWrapPos(ImGui::GetFontSize() * 24);
  ImGui::TextUnformatted(text.c_str());
  ImGui::PopTextWrapPos();
  ImGui::EndTooltip();
}

}  // namespace

FrontAnswer frontPlot(glm::vec2 size, const FrontPlot& plot) {
  FrontAnswer answer;
  const ImVec2 corner = ImGui::GetCursorScreenPos();
  const float text = ImGui::GetTextLineHeight(), pad = 0.3f * text, radius = std::max(3.0f, 0.26f * text);
  if (plot.points.empty() || size.x < 8 * text || size.y < 5 * text) {
    ImGui::Dummy({size.x, size.y});
    return answer;
  }
  const ImVec2 begin = ImGui::GetCursorPos();
  ImDrawList& list = *ImGui::GetWindowDrawList();
  const ImU32 dim = ImGui::GetColorU32(theme::dim), grid = ImGui::GetColorU32(ImGuiCol_Border),
              accent = ImGui::GetColorU32(theme::accent), bright = ImGui::GetColorU32(theme::text);

  double least = HUGE_VAL, most = 0, cheapest = HUGE_VAL, dearest = 0;
  for (const FrontPlot::Point& p : plot.points) {
    least = std::min(least, p.at.error), most = std::max(most, p.at.error);
    cheapest = std::min(cheapest, p.at.cost), dearest = std::max(dearest, p.at.cost);
  }
  LogAxis x = LogAxis::around(cheapest, dearest), y = LogAxis::around(least, most);
  y.from = corner.y + size.y - text - pad, y.to = corner.y + 1.5f * text;
  const std::vector<double> rows = y.ticks(static_cast<int>((y.from - y.to) / (1.6f * text)));
  float margin = 0;
  for (const double v : rows) margin = std::max(margin, ImGui::CalcTextSize(tickText(v).c_str()).x);
  x.from = corner.x + margin + 2 * pad, x.to = corner.x + size.x - pad;

  list.AddText({corner.x, corner.y}, dim, "relMSE");
  list.AddRectFilled({x.from, y.to}, {x.to, y.from}, ImGui::GetColorU32(ImGuiCol_FrameBg));
  for (const double v : rows) {
    const std::string label = tickText(v);
    list.AddLine({x.from, y.at(v)}, {x.to, y.at(v)}, grid);
    list.AddText({x.from - pad - ImGui::CalcTextSize(label.c_str()).x, y.at(v) - 0.5f * text}, dim, label.c_str());
  }
  const std::string unit = " " + plot.costUnit;
  const float unitWidth = ImGui::CalcTextSize(unit.c_str()).x;
  float free = x.from;  // labels may not run into each other, nor into the unit
  for (const double v : x.ticks(static_cast<int>((x.to - x.from) / (2.5f * text)))) {
    const std::string label = tickText(v);
    const float half = 0.5f * ImGui::CalcTextSize(label.c_str()).x;
    list.AddLine({x.at(v), y.to}, {x.at(v), y.from}, grid);
    if (x.at(v) - half < free || x.at(v) + half > x.to - unitWidth) continue;
    list.AddText({x.at(v) - half, y.from + 0.5f * pad}, dim, label.c_str());
    free = x.at(v) + half + pad;
  }
  list.AddText({x.to - unitWidth, y.from + 0.5f * pad}, dim, unit.c_str());

  // The front by steps: what lies above and to the right of them is no better.
  std::vector<const FrontPlot::Point*> front;
  for (const FrontPlot::Point& p : plot.points)
    if (p.onFront) front.push_back(&p);
  std::sort(front.begin(), front.end(), [](auto* a, auto* b) { return a->at.cost < b->at.cost; });
  for (size_t i = 0; i + 1 < front.size(); ++i) {
    const ImVec2 a{x.at(front[i]->at.cost), y.at(front[i]->at.error)},
        b{x.at(front[i + 1]->at.cost), y.at(front[i + 1]->at.error)};
    list.AddLine(a, {b.x, a.y}, dim);
    list.AddLine({b.x, a.y}, b, dim);
  }

  // Those on the front lie on top, and take the mouse where several are under it.
  std::vector<const FrontPlot::Point*> order;
  for (const FrontPlot::Point& p : plot.points) order.push_back(&p);
  std::stable_sort(order.begin(), order.end(), [](auto* a, auto* b) { return a->onFront > b->onFront; });
  for (const FrontPlot::Point* p : order) {
    const ImVec2 at{x.at(p->at.cost), y.at(p->at.error)};
    ImGui::SetCursorScreenPos({at.x - 1.5f * radius, at.y - 1.5f * radius});
    if (ImGui::InvisibleButton(fmt::format("point {}", p->number).c_str(), {3 * radius, 3 * radius}))
      answer.clicked = p->number;
    if (ImGui::IsItemHovered()) {
      answer.hovered = p->number;
      tooltip(p->text);
    }
  }
  for (auto it = order.rbegin(); it != order.rend(); ++it) {
    const FrontPlot::Point& p = **it;
    const ImVec2 at{x.at(p.at.cost), y.at(p.at.error)};
    const bool hovered = answer.hovered == p.number, here = plot.here == p.number;
    const ImU32 color = hovered ? bright : p.onFront ? ImGui::GetColorU32(theme::good) : dim;
    if (p.half > 0 && std::isfinite(p.half)) {
      const double bottom = std::max(p.at.error - p.half, y.low);
      list.AddLine({at.x, y.at(p.at.error + p.half)}, {at.x, y.at(bottom)}, color, 1.0f);
    }
    if (p.onFront)
      list.AddCircleFilled(at, radius, color);
    else
      list.AddCircle(at, radius, color, 0, 1.5f);
    if (here) list.AddCircle(at, 1.9f * radius, accent, 0, plot.exactly ? 2.0f : 1.0f);
  }
  ImGui::SetCursorPos(begin);
  ImGui::Dummy({size.x, size.y});
  return answer;
}

}  // namespace irad
