// Finding and fitting what judges of named studies look at.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include "gi/study/claims.h"
#include "gi/study/plot.h"
#include "renderer/base/number_text.h"

namespace irad {

double ExperimentResult::light(const PointSummary& p) const {
  const auto mean = figures.find("truth_mean");
  return (mean == figures.end() ? std::numeric_limits<double>::quiet_NaN() : mean->second) + p.meanError.mean;
}

std::vector<const ExperimentResult*> NamedResults::measured(std::string_view prefix) const {
  std::vector<const ExperimentResult*> out;
  for (const ExperimentResult& e : experiments)
    if (e.skipped.empty() && e.experiment.name.starts_with(prefix) &&
        std::ranges::all_of(e.points, [](const MeasuredPoint& p) { return p.summary.failure.empty(); }))
      out.push_back(&e);
  return out;
}

const ExperimentResult& experimentOf(const NamedResults& results, std::string_view name) {
  for (const ExperimentResult& e : results.experiments) {
    if (e.experiment.name != name) continue;
    if (!e.skipped.empty()) throw NotMeasured(fmt::format("{}: {}", name, e.skipped));
    return e;
  }
  throw NotMeasured(fmt::format("{}: no such experiment", name));
}

const PointSummary& pointOf(const ExperimentResult& e, const std::map<std::string, std::string>& settings) {
  for (const MeasuredPoint& point : e.points) {
    const bool fits = std::ranges::all_of(settings, [&](const auto& wanted) {
      const auto value = point.settings.find(wanted.first);
      return value != point.settings.end() && value->second == wanted.second;
    });
    if (!fits) continue;
    const PointSummary& p = point.summary;
    if (p.seeds == 0) throw NotMeasured(fmt::format("{}, {}: {}", e.experiment.name, p.label, p.failure));
    return p;
  }
  std::string wanted;
  for (const auto& [name, value] : settings) wanted += fmt::format(" {}={}", name, value);
  throw NotMeasured(fmt::format("{}: no point with{}", e.experiment.name, wanted));
}

Answer answerTo(const Claim& claim, const NamedResults& results) {
  try {
    return claim.judge(results);
  } catch (const NotMeasured& missing) {
    return {Judgement::Open, fmt::format("Not measured: {}.", missing.what())};
  }
}

double exponentOf(const std::vector<std::pair<double, double>>& points) {
  double n = 0, x = 0, y = 0, xx = 0, xy = 0;
  for (const auto& [a, b] : points) {
    const double u = std::log(a), v = std::log(b);
    n += 1, x += u, y += v, xx += u * u, xy += u * v;
  }
  const double spread = n * xx - x * x;
  return n < 2 || spread <= 0 ? std::numeric_limits<double>::quiet_NaN() : (n * xy - x * y) / spread;
}

IntervalOrder compare(const MeanInterval& a, const MeanInterval& b) {
  if (!std::isfinite(a.half) || !std::isfinite(b.half)) return IntervalOrder::Unknown;
  if (std::abs(a.mean - b.mean) <= a.half + b.half) return IntervalOrder::Equal;
  return a.mean < b.mean ? IntervalOrder::Less : IntervalOrder::More;
}

NoiseFit fitNoise(const std::vector<std::pair<double, double>>& points) {
  double n = 0, x = 0, y = 0, xx = 0, xy = 0;
  for (const auto& [rays, error] : points) {
    const double u = 1 / rays;
    n += 1, x += u, y += error, xx += u * u, xy += u * error;
  }
  const double spread = n * xx - x * x;
  if (n < 2 || spread <= 0) throw NotMeasured("fewer than two lengths of rows");
  NoiseFit fit;
  fit.slope = (n * xy - x * y) / spread;
  fit.bias = (y - fit.slope * x) / n;
  return fit;
}

double leastAt(const std::vector<std::pair<double, double>>& points) {
  if (points.empty()) throw NotMeasured("no points");
  size_t least = 0;
  for (size_t i = 1; i < points.size(); ++i)
    if (points[i].second < points[least].second) least = i;
  if (least == 0 || least + 1 == points.size()) return points[least].first;
  const auto [x0, y0] = points[least - 1];
  const auto [x1, y1] = points[least];
  const auto [x2, y2] = points[least + 1];
  // The vertex of the parabola through three points.
  const double a = (x1 - x0) * (y1 - y2), b = (x1 - x2) * (y1 - y0);
  return a == b ? x1 : x1 - .5 * ((x1 - x0) * a - (x1 - x2) * b) / (a - b);
}

namespace claims {

std::string percent(double share) {
  return fmt::format("{:.{}f} %", 100 * share, std::abs(share) < .1 ? 1 : 0);
}
std::string signedPercent(double share) {
  return fmt::format("{:+.{}f} %", 100 * share, std::abs(share) < .1 ? 1 : 0);
}
std::string withInterval(const MeanInterval& m) {
  return std::isfinite(m.half) ? fmt::format("{} ± {}", shortNumber(m.mean), shortNumber(m.half)) : shortNumber(m.mean);
}
double stageMs(const PointSummary& p, const char* kind, std::string_view prefix) {
  const auto stages = p.stages.find(kind);
  double sum = 0;
  bool any = false;
  if (stages != p.stages.end())
    for (const auto& [stage, spread] : stages->second)
      if (stage.starts_with(prefix)) sum += spread.p50, any = true;
  if (!any) throw NotMeasured(fmt::format("{}: no times of {}", p.label, prefix));
  return sum;
}
double kindMs(const PointSummary& p, const char* kind) {
  const double ms = p.gpuMs(kind);
  if (!std::isfinite(ms)) throw NotMeasured(fmt::format("{}: no times", p.label));
  return ms;
}
std::vector<const ExperimentResult*> ending(const NamedResults& r, std::string_view suffix) {
  std::vector<const ExperimentResult*> out;
  for (const ExperimentResult* e : r.measured())
    if (e->experiment.name.ends_with(suffix)) out.push_back(e);
  if (out.empty()) throw NotMeasured(fmt::format("no experiment {}", suffix));
  return out;
}
double meanOf(const std::vector<double>& values) {
  return std::accumulate(values.begin(), values.end(), 0.0) / static_cast<double>(values.size());
}
const char* caveat(const NamedResults& r) {
  return r.cpu && r.full ? " (on a CPU device: the thesis's figures are of a GPU)"
         : r.cpu         ? " (small scale on a CPU device: the thesis's figures are of 256 voxels on a GPU)"
         : r.full        ? ""
                         : " (small scale: the thesis's figures are of 256 voxels)";
}
bool comparableTimes(const NamedResults& r) {
  return r.full && !r.cpu;
}

Judgement atFullSize(const NamedResults& r, bool agrees) {
  return r.full ? agreesIf(agrees) : Judgement::Open;
}

double figureOf(const ExperimentResult& e, const std::string& name) {
  const auto found = e.figures.find(name);
  if (found == e.figures.end()) throw NotMeasured(fmt::format("{}: {}", e.experiment.name, name));
  return found->second;
}
std::string listed(const std::vector<std::pair<std::string, double>>& times) {
  std::vector<std::string> out;
  for (const auto& [scene, ms] : times) out.push_back(fmt::format("{} {} ms", scene, plainNumber(ms)));
  return fmt::format("{}", fmt::join(out, ", "));
}

std::vector<const ExperimentResult*> allMeasured(const NamedResults& r) {
  std::vector<const ExperimentResult*> out = r.measured();
  if (!out.empty()) return out;
  throw NotMeasured(r.experiments.empty() ? "no experiment" : r.experiments.front().skipped);
}

}  // namespace claims
}  // namespace irad
