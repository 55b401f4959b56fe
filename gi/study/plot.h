// Plots as SVG: dark on light, without scripts, readable by themselves.
#pragma once

#include <optional>
#include <string>
#include <vector>

namespace irad {

/// A marker with its spreads, at (x, y), both > 0.
struct PlotPoint {
  double x = 0, y = 0;
  double xLow = 0, xHigh = 0, yLow = 0, yHigh = 0;  ///< not drawn where they are x and y
  std::string label;                                ///< beside the marker, where there is room
  std::string hint;                                 ///< what a browser shows under the pointer
};
enum class PlotStyle { Front, Dominated, Given, Peer };
struct PlotSeries {
  std::string name;  ///< in the legend
  PlotStyle style;
  std::vector<PlotPoint> points;
};
/// Both axes logarithmic. The front is joined by steps (what lies above and to the right is no better), a peer by
/// lines.
std::string logPlot(const std::string& xAxis, const std::string& yAxis, const std::vector<PlotSeries>& series);

/// A bar of parts side by side, from 0.
struct Bar {
  std::string label;
  std::vector<double> parts;  ///< as many as there are names
};
/// Bars below each other, `names` of their parts in the legend. Parts below 0 are left out.
std::string stackedBars(const std::string& axis, const std::vector<std::string>& names, const std::vector<Bar>& bars,
                        const std::string& unit = "ms");

/// Three digits, and no exponent where it can be read without.
std::string plainNumber(double value);
std::string escapeXml(const std::string& text);

}  // namespace irad
