#include "gi/study/tune.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <set>

namespace irad {
namespace {

std::string textOf(const Setting& setting, double value) {
  const SettingRange& range = setting.range;
  if (range.step > 0) value = range.min + range.step * std::round((value - range.min) / range.step);
  value = std::clamp(value, range.min, range.max);
  return setting.kind == SettingKind::integer ? fmt::format("{:.0f}", std::round(value))
                                              : fmt::format("{}", static_cast<float>(value));
}

double valueOf(const std::string& text) {
  double value = 0;
  std::from_chars(text.data(), text.data() + text.size(), value);
  return value;
}

}  // namespace

std::optional<size_t> nearest(const std::vector<PointSummary>& points, const CostKind& cost, const Budget& budget) {
  if (const std::optional<size_t> within = pick(points, cost, budget)) return within;
  std::optional<size_t> best;
  double least = 0;
  for (size_t i = 0; i < points.size(); ++i) {
    const PointSummary& p = points[i];
    if (!p.failure.empty() || !std::isfinite(cost.of(p)) || !std::isfinite(p.relMse.mean)) continue;
    double excess = 0;
    if (budget.ms) excess = std::max(excess, cost.of(p) / *budget.ms);
    if (budget.mib) excess = std::max(excess, p.deviceMib / *budget.mib);
    if (budget.error) excess = std::max(excess, p.relMse.mean / *budget.error);
    if (!best || excess < least) best = i, least = excess;
  }
  return best;
}

std::vector<std::string> around(const SettingGrid& grid, size_t point) {
  std::vector<std::string> out;
  bool any = false;
  for (size_t column = 0; column < grid.swept().size(); ++column) {
    const Setting& setting = *grid.swept()[column];
    const std::string here = grid.values(point)[column];
    std::string sweep = fmt::format("{}={}", setting.name, here);
    if (setting.kind == SettingKind::integer || setting.kind == SettingKind::number) {
      std::set<double> values;
      for (size_t i = 0; i < grid.size(); ++i) values.insert(valueOf(grid.values(i)[column]));
      const auto at = values.find(valueOf(here));
      const double value = *at;
      const double below = at != values.begin() ? *std::prev(at) : 0,
                   above = std::next(at) != values.end() ? *std::next(at) : 0;
      const auto add = [&](double neighbour, double beyond) {
        // Beyond the last value: as far, by the quotient, as the one on the other side is away.
        const double to = neighbour > 0 ? neighbour : beyond > 0 ? value * value / beyond : 0;
        if (value <= 0 || to <= 0 || std::max(to / value, value / to) < kCloseEnough * kCloseEnough) return;
        const std::string text = textOf(setting, neighbour > 0 ? std::sqrt(value * to) : to);
        if (text == here) return;
        sweep += "," + text;
        any = true;
      };
      add(below, above);
      add(above, below);
    }
    out.push_back(std::move(sweep));
  }
  return any ? out : std::vector<std::string>{};
}

namespace {

template <class Keep>
StudyResults filtered(StudyResults results, uint32_t firstSeed, uint32_t seeds, uint32_t repeats, Keep keep) {
  std::erase_if(results.errors, [&](const ErrorRow& r) { return !keep(r.seed - firstSeed < seeds); });
  std::erase_if(results.times, [&](const TimeRow& r) { return !keep(r.repeat < repeats); });
  return results;
}

}  // namespace

StudyResults chosenBy(StudyResults results, uint32_t firstSeed, uint32_t seeds, uint32_t repeats) {
  return filtered(std::move(results), firstSeed, seeds, repeats, [](bool first) { return first; });
}

StudyResults unseen(StudyResults results, uint32_t firstSeed, uint32_t seeds, uint32_t repeats) {
  return filtered(std::move(results), firstSeed, seeds, repeats, [](bool first) { return !first; });
}

}  // namespace irad
