#include "gi/study/slope.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <string_view>

#include "renderer/base/error.h"

namespace irad {
namespace {

double distance(const Setting& setting, double a, double b) {
  if (a == b) return 0;
  if (setting.kind == SettingKind::toggle || setting.kind == SettingKind::choice) return 1;
  if (a > 0 && b > 0) return std::abs(std::log(a / b));
  return std::abs(a - b) / (setting.range.max - setting.range.min);
}

}  // namespace

bool countsInStudies(const Setting& setting) {
  const std::string_view name = setting.name, group = setting.group();
  return group != "view" && group != "camera" && name != "matrix.seed" && name != "solver.sweeps_per_frame";
}

std::optional<PlaceInStudy> placeOf(std::span<const Settings> points, const std::vector<bool>& usable,
                                    const Settings& now) {
  IRAD_CHECK_OP(points.size(), ==, usable.size());
  std::optional<PlaceInStudy> place;
  double least = std::numeric_limits<double>::infinity();
  for (size_t i = 0; i < points.size(); ++i) {
    if (!usable[i]) continue;
    double far = 0;
    for (const Setting& setting : settingTable())
      if (countsInStudies(setting)) far += distance(setting, setting.get(points[i]), setting.get(now));
    if (far < least) least = far, place = PlaceInStudy{i, {}};
  }
  if (!place) return place;
  for (const Setting& setting : settingTable())
    if (countsInStudies(setting) && setting.get(points[place->point]) != setting.get(now))
      place->apart.push_back(
          fmt::format("{} {} instead of {}", setting.name, setting.text(points[place->point]), setting.text(now)));
  return place;
}

double Slope::errorFor(const CostAndError& at, double more) const {
  return at.error * std::pow((at.cost + more) / at.cost, -exponent);
}

Slope slopeAt(std::span<const CostAndError> points, size_t at) {
  IRAD_CHECK_OP(at, <, points.size());
  const CostAndError& here = points[at];
  IRAD_CHECK(here.cost > 0 && here.error > 0, "point {}: cost {}, error {}", at, here.cost, here.error);
  Slope slope;
  for (const size_t i : front(points)) {
    if (points[i].error >= here.error) continue;
    if (points[i].cost <= here.cost) {
      slope.better = i;  // the front's errors fall: the last is the least
    } else if (points[i].error > 0) {
      slope.next = i;
      slope.exponent = std::log(here.error / points[i].error) / std::log(points[i].cost / here.cost);
      break;
    }
  }
  return slope;
}

}  // namespace irad
