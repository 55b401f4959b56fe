#include "gi/study/plot.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "renderer/base/number_text.h"
#include "renderer/base/ticks.h"

namespace irad {
namespace {

// A palette that keeps its order for people who see colours differently (Okabe and Ito 2008), but for yellow.
constexpr std::array kPartColors{"#0072b2", "#e69f00", "#009e73", "#cc79a7",
                                 "#56b4e9", "#d55e00", "#7f7fbf", "#8c6d31"};
constexpr const char *kRestColor = "#b0b0b0", *kText = "#222222", *kGrid = "#dddddd";

/// Width of a text of 12 px in a sans serif, on the safe side.
double textWidth(const std::string& text) {
  const auto characters = std::ranges::count_if(text, [](char c) { return (c & 0xC0) != 0x80; });
  return 7.0 * static_cast<double>(characters);
}

struct Box {
  double x0, y0, x1, y1;
  bool meets(const Box& o) const { return x0 < o.x1 && o.x0 < x1 && y0 < o.y1 && o.y0 < y1; }
};

std::string text(double x, double y, const char* anchor, const std::string& words, const char* more = "") {
  return fmt::format("<text x=\"{:.1f}\" y=\"{:.1f}\" text-anchor=\"{}\" {}>{}</text>\n", x, y, anchor, more,
                     escapeXml(words));
}
std::string line(double x0, double y0, double x1, double y1, const char* color, double width = 1) {
  return fmt::format(
      "<line x1=\"{:.1f}\" y1=\"{:.1f}\" x2=\"{:.1f}\" y2=\"{:.1f}\" stroke=\"{}\" stroke-width=\"{}\"/>\n", x0, y0, x1,
      y1, color, width);
}
std::string begin(double width, double height) {
  return fmt::format(
      "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 {0:.0f} {1:.0f}\" width=\"{0:.0f}\" height=\"{1:.0f}\" "
      "font-family=\"Inter, DejaVu Sans, Helvetica, Arial, sans-serif\" font-size=\"12\" fill=\"{2}\">\n"
      "<rect width=\"100%\" height=\"100%\" fill=\"#ffffff\"/>\n",
      width, height, kText);
}

struct LogAxis {
  double low, high, from, to;  ///< values, and where they lie
  double at(double value) const { return from + (to - from) * std::log(value / low) / std::log(high / low); }
};

LogAxis logAxis(double low, double high, double from, double to) {
  if (!(low > 0) || !(high >= low)) low = 1, high = 10;
  const double margin = std::max(std::pow(high / low, .07), 1.12);
  return {low / margin, high * margin, from, to};
}

/// 1, 2, 5 times powers of ten; over more than three decades the powers alone.
std::vector<double> logTicks(const LogAxis& axis) {
  std::vector<double> out;
  const bool wide = axis.high / axis.low > 1000;
  for (int decade = static_cast<int>(std::floor(std::log10(axis.low))); decade <= std::log10(axis.high); ++decade)
    for (const double digit : {1.0, 2.0, 5.0}) {
      const double value = digit * std::pow(10.0, decade);
      if (value >= axis.low && value <= axis.high && (!wide || digit == 1)) out.push_back(value);
    }
  if (out.size() < 2) out = ticks(axis.low, axis.high, 5);
  std::erase_if(out, [](double value) { return value <= 0; });
  return out;
}

struct Look {
  const char *color, *fill;
  double radius;
};
Look lookOf(PlotStyle style) {
  switch (style) {
    case PlotStyle::Front:
      return {"#0072b2", "#0072b2", 5};
    case PlotStyle::Dominated:
      return {"#777777", "#ffffff", 4};
    case PlotStyle::Given:
      return {"#d62728", "none", 9};
    case PlotStyle::Peer:
      return {"#c25a00", "#e69f00", 5};
  }
  return {};
}
std::string marker(PlotStyle style, double x, double y, const std::string& hint) {
  const Look look = lookOf(style);
  const std::string title = hint.empty() ? "" : fmt::format("<title>{}</title>", escapeXml(hint));
  if (style == PlotStyle::Peer)
    return fmt::format(
        "<path d=\"M{0:.1f} {1:.1f}m0 -6l6 6l-6 6l-6 -6z\" fill=\"{2}\" stroke=\"{3}\" "
        "stroke-width=\"1.2\">{4}</path>\n",
        x, y, look.fill, look.color, title);
  return fmt::format(
      "<circle cx=\"{:.1f}\" cy=\"{:.1f}\" r=\"{}\" fill=\"{}\" stroke=\"{}\" stroke-width=\"1.6\">{}</circle>\n", x, y,
      look.radius, look.fill, look.color, title);
}

}  // namespace

std::string plainNumber(double value) {
  return std::abs(value) >= 999.5 && std::abs(value) < 1e7 ? fmt::format("{:.0f}", value) : shortNumber(value);
}

std::string escapeXml(const std::string& text) {
  std::string out;
  for (const char c : text) switch (c) {
      case '&':
        out += "&amp;";
        break;
      case '<':
        out += "&lt;";
        break;
      case '>':
        out += "&gt;";
        break;
      case '"':
        out += "&quot;";
        break;
      default:
        out += c;
    }
  return out;
}

std::string logPlot(const std::string& xAxis, const std::string& yAxis, const std::vector<PlotSeries>& series) {
  const double width = 820, height = 480, left = 84, right = 800, top = 44, bottom = 424;
  double xLow = HUGE_VAL, xHigh = 0, yLow = HUGE_VAL, yHigh = 0;
  for (const PlotSeries& s : series)
    for (const PlotPoint& p : s.points) {
      xLow = std::min(xLow, p.x), xHigh = std::max(xHigh, p.x);
      yLow = std::min(yLow, p.y), yHigh = std::max(yHigh, p.y);
    }
  const LogAxis x = logAxis(xLow, xHigh, left, right), y = logAxis(yLow, yHigh, bottom, top);
  const auto inX = [&](double value) { return std::clamp(x.at(std::max(value, x.low)), left, right); };
  const auto inY = [&](double value) { return std::clamp(y.at(std::max(value, y.low)), top, bottom); };

  std::string out = begin(width, height);
  for (const double tick : logTicks(x)) {
    out += line(x.at(tick), top, x.at(tick), bottom, kGrid);
    out += text(x.at(tick), bottom + 18, "middle", plainNumber(tick));
  }
  for (const double tick : logTicks(y)) {
    out += line(left, y.at(tick), right, y.at(tick), kGrid);
    out += text(left - 8, y.at(tick) + 4, "end", plainNumber(tick));
  }
  out += fmt::format("<rect x=\"{}\" y=\"{}\" width=\"{}\" height=\"{}\" fill=\"none\" stroke=\"#888888\"/>\n", left,
                     top, right - left, bottom - top);
  out += text((left + right) / 2, bottom + 42, "middle", xAxis, "font-weight=\"600\"");
  out +=
      text(0, 0, "middle", yAxis,
           fmt::format("font-weight=\"600\" transform=\"translate(20 {}) rotate(-90)\"", (top + bottom) / 2).c_str());

  // The legend, above the frame.
  double at = left;
  for (const PlotSeries& s : series) {
    if (s.points.empty()) continue;
    out += marker(s.style, at + 10, top - 20, "");
    out += text(at + 24, top - 16, "start", s.name);
    at += 24 + textWidth(s.name) + 24;
  }

  std::vector<Box> taken;
  for (const PlotSeries& s : series) {
    const Look look = lookOf(s.style);
    std::vector<PlotPoint> sorted = s.points;
    std::ranges::sort(sorted, {}, &PlotPoint::x);
    std::string path;
    for (size_t i = 0; i < sorted.size(); ++i) {
      const double px = x.at(sorted[i].x), py = y.at(sorted[i].y);
      taken.push_back({px - 7, py - 7, px + 7, py + 7});
      if (i == 0)
        path = fmt::format("M{:.1f} {:.1f}", px, py);
      else
        path +=
            s.style == PlotStyle::Front ? fmt::format("H{:.1f}V{:.1f}", px, py) : fmt::format("L{:.1f} {:.1f}", px, py);
    }
    if (!sorted.empty() && (s.style == PlotStyle::Front || s.style == PlotStyle::Peer))
      out += fmt::format("<path d=\"{}\" fill=\"none\" stroke=\"{}\" stroke-width=\"1.6\"{}/>\n", path, look.color,
                         s.style == PlotStyle::Peer ? " stroke-dasharray=\"5 4\"" : "");
  }
  for (const PlotSeries& s : series)
    for (const PlotPoint& p : s.points) {
      const Look look = lookOf(s.style);
      if (p.xLow < p.xHigh) out += line(inX(p.xLow), y.at(p.y), inX(p.xHigh), y.at(p.y), look.color);
      if (p.yLow < p.yHigh) out += line(x.at(p.x), inY(p.yLow), x.at(p.x), inY(p.yHigh), look.color);
    }
  for (const PlotSeries& s : series)
    for (const PlotPoint& p : s.points) out += marker(s.style, x.at(p.x), y.at(p.y), p.hint);
  // Labels where nothing is: right above, right below, left above, left below, above, below.
  for (const PlotSeries& s : series)
    for (const PlotPoint& p : s.points) {
      if (p.label.empty()) continue;
      const double w = textWidth(p.label), px = x.at(p.x), py = y.at(p.y);
      for (const auto& [dx, dy] :
           {std::pair(8.0, -8.0), {8.0, 17.0}, {-8.0 - w, -8.0}, {-8.0 - w, 17.0}, {-w / 2, -11.0}, {-w / 2, 20.0}}) {
        const Box box{px + dx - 1, py + dy - 11, px + dx + w + 1, py + dy + 3};
        if (box.x0 < left || box.x1 > right || box.y0 < top || box.y1 > bottom) continue;
        if (std::ranges::any_of(taken, [&](const Box& other) { return other.meets(box); })) continue;
        out += text(px + dx, py + dy, "start", p.label, "stroke=\"#ffffff\" stroke-width=\"3\" paint-order=\"stroke\"");
        taken.push_back(box);
        break;
      }
    }
  return out + "</svg>\n";
}

std::string stackedBars(const std::string& axis, const std::vector<std::string>& names, const std::vector<Bar>& bars,
                        const std::string& unit) {
  const double width = 820, rowHeight = 24;
  double labels = 60, most = 0;
  for (const Bar& bar : bars) {
    labels = std::max(labels, textWidth(bar.label) + 16);
    double sum = 0;
    for (const double part : bar.parts) sum += std::max(part, 0.0);
    most = std::max(most, sum);
  }
  labels = std::min(labels, 420.0);
  const double left = labels, right = width - 76;
  if (most <= 0) most = 1;
  const auto colorOf = [&](size_t part) { return part < kPartColors.size() ? kPartColors[part] : kRestColor; };

  // The legend, in as many lines as it takes.
  std::string legend;
  double x = left, y = 18;
  for (size_t i = 0; i < names.size(); ++i) {
    const double need = 18 + textWidth(names[i]) + 16;
    if (x + need > width && x > left) x = left, y += 20;
    legend += fmt::format("<rect x=\"{:.1f}\" y=\"{:.1f}\" width=\"12\" height=\"12\" fill=\"{}\"/>\n", x, y - 10,
                          colorOf(i));
    legend += text(x + 18, y, "start", names[i]);
    x += need;
  }
  const double top = y + 14, bottom = top + rowHeight * static_cast<double>(bars.size()), height = bottom + 48;
  const auto at = [&](double value) { return left + (right - left) * value / most; };
  std::string out = begin(width, height) + legend;
  for (const double tick : ticks(0, most, 7)) {
    out += line(at(tick), top, at(tick), bottom, kGrid);
    out += text(at(tick), bottom + 16, "middle", plainNumber(tick));
  }
  out += text((left + right) / 2, bottom + 38, "middle", axis, "font-weight=\"600\"");
  for (size_t row = 0; row < bars.size(); ++row) {
    const double barTop = top + rowHeight * static_cast<double>(row) + 3;
    std::string label = bars[row].label;
    if (textWidth(label) + 16 > labels) label = label.substr(0, static_cast<size_t>(labels / 7) - 4) + "…";
    out += text(left - 8, barTop + 13, "end", label);
    double sum = 0;
    for (size_t part = 0; part < bars[row].parts.size(); ++part) {
      const double value = bars[row].parts[part];
      if (value <= 0) continue;
      out += fmt::format(
          "<rect x=\"{:.2f}\" y=\"{:.1f}\" width=\"{:.2f}\" height=\"{}\" fill=\"{}\"><title>{}: {} "
          "{}</title></rect>\n",
          at(sum), barTop, at(sum + value) - at(sum), rowHeight - 6, colorOf(part), escapeXml(names[part]),
          plainNumber(value), unit);
      sum += value;
    }
    out += text(at(sum) + 6, barTop + 13, "start", plainNumber(sum));
  }
  out += line(left, top, left, bottom, "#888888");
  return out + "</svg>\n";
}

}  // namespace irad
