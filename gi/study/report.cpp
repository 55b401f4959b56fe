#include "gi/study/report.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <nlohmann/json.hpp>

#include "gi/study/front.h"
#include "gi/study/html.h"
#include "gi/study/plot.h"
#include "gi/study/report_parts.h"
#include "renderer/base/error.h"
#include "renderer/base/number_text.h"
#include "renderer/base/output_file.h"

namespace irad {
namespace {

namespace fs = std::filesystem;

std::vector<CostAndError> pairsOf(const std::vector<PointSummary>& points, const CostKind& cost) {
  std::vector<CostAndError> out;
  for (const PointSummary& p : points) out.push_back({cost.of(p), p.relMse.mean});
  return out;
}

std::string amount(const CostKind& cost, double value) {
  return fmt::format("{} {}", plainNumber(value), cost.unit);
}
/// Whether it is not known which of two errors is less.
const char* orNot(const PointSummary& a, const PointSummary& b) {
  const bool overlap = std::abs(a.relMse.mean - b.relMse.mean) < a.relMse.half + b.relMse.half;
  return std::isfinite(a.relMse.half + b.relMse.half) && overlap ? " (their intervals overlap)" : "";
}
std::string named(const PointSummary& p) {
  return fmt::format("{} ({})", p.point, p.label);
}

/// The seconds after which a peer's error is `error`, between two of its pictures; none beyond them.
std::optional<double> secondsFor(std::vector<PeerRow> peers, double error) {
  std::erase_if(peers, [](const PeerRow& p) { return p.relMse <= 0 || p.seconds <= 0; });
  std::ranges::sort(peers, {}, &PeerRow::seconds);
  for (size_t i = 0; i + 1 < peers.size(); ++i) {
    const PeerRow &a = peers[i], &b = peers[i + 1];
    if ((a.relMse - error) * (b.relMse - error) > 0 || a.relMse == b.relMse) continue;
    const double share = std::log(error / a.relMse) / std::log(b.relMse / a.relMse);
    return a.seconds * std::pow(b.seconds / a.seconds, share);
  }
  return std::nullopt;
}

}  // namespace

std::string errorFinding(const CostKind& cost, const std::vector<PointSummary>& points,
                         const std::vector<PeerRow>& peers, std::optional<size_t> given) {
  const std::vector<CostAndError> pairs = pairsOf(points, cost);
  const std::vector<size_t> best = front(pairs);
  std::string name = cost.name;
  std::ranges::replace(name, '_', ' ');
  name[0] = static_cast<char>(name[0] - 'a' + 'A');
  if (best.empty()) return fmt::format("{}: nothing was measured.", name);
  const PointSummary &cheap = points[best.front()], &good = points[best.back()];
  std::string out = fmt::format("{}: {} of {} points {} on the front", name, best.size(), points.size(),
                                best.size() == 1 ? "is" : "are");
  if (best.size() == 1)
    out += fmt::format(", {} with relMSE {} at {}.", named(good), shortNumber(good.relMse.mean),
                       amount(cost, cost.of(good)));
  else
    out += fmt::format(", from relMSE {} at {} with {} to {} at {} with {}.", shortNumber(cheap.relMse.mean),
                       amount(cost, cost.of(cheap)), named(cheap), shortNumber(good.relMse.mean),
                       amount(cost, cost.of(good)), named(good));
  std::optional<size_t> from;
  if (given && std::isfinite(pairs[*given].cost) && std::isfinite(pairs[*given].error)) {
    from = given;
    if (const std::optional<size_t> by = dominators(pairs)[*given]) {
      out +=
          fmt::format(" The settings given, {}, are not: {} has {} of their error{} for {} of their {}.",
                      named(points[*given]), named(points[*by]), shortNumber(pairs[*by].error / pairs[*given].error),
                      orNot(points[*by], points[*given]), shortNumber(pairs[*by].cost / pairs[*given].cost), cost.unit);
      from = by;
    } else {
      out += fmt::format(" The settings given, {}, are on it.", named(points[*given]));
    }
  }
  const auto place = from ? std::ranges::find(best, *from) : best.begin();
  if (place != best.end() && place + 1 != best.end()) {
    const CostAndError &here = pairs[*place], &next = pairs[*(place + 1)];
    out += fmt::format(" From {} the next on the front, {}, has {} % less error{} for {} more.", *place, *(place + 1),
                       shortNumber(100 * (1 - next.error / here.error)), orNot(points[*place], points[*(place + 1)]),
                       amount(cost, next.cost - here.cost));
  }
  if (cost.time && !peers.empty()) {
    if (const std::optional<double> seconds = secondsFor(peers, good.relMse.mean))
      out += fmt::format(" The path tracer takes about {} ms for the error of point {}, {} times as long.",
                         plainNumber(1e3 * *seconds), good.point, plainNumber(1e3 * *seconds / cost.of(good)));
    else
      out +=
          fmt::format(" None of the path tracer's pictures lies on either side of the error of point {}.", good.point);
  }
  return out;
}

std::string reportCrop(const fs::path& folder, const std::string& name, const std::string& caption,
                       const ReportNotes& notes) {
  return htmlFigure(folder / "pictures" / name, {notes.pictureSize, notes.cropAt, notes.cropSize}, caption);
}

namespace {

/// Pictures beside each other that took the same time, and that have the same error: around the settings given or,
/// where those are on the front, around the point that is furthest from it.
std::string crops(const fs::path& folder, const std::vector<PointSummary>& points, const std::vector<PeerRow>& peers,
                  std::optional<size_t> given, const ReportNotes& notes) {
  const CostKind& cost = costKinds().front();
  const std::vector<CostAndError> pairs = pairsOf(points, cost);
  const std::vector<std::optional<size_t>> by = dominators(pairs);
  const std::vector<size_t> best = front(pairs);
  if (best.empty()) return "<p>No pictures: no point has both a time and an error.</p>\n";
  std::optional<size_t> anchor;
  if (given && std::isfinite(pairs[*given].cost) && std::isfinite(pairs[*given].error) && by[*given]) anchor = given;
  double furthest = 1;
  for (size_t i = 0; i < points.size() && !(given && anchor == given); ++i)
    if (by[i] && std::isfinite(pairs[i].cost) && std::isfinite(pairs[i].error) &&
        pairs[i].error / pairs[*by[i]].error > furthest)
      furthest = pairs[i].error / pairs[*by[i]].error, anchor = i;
  const bool alone = !anchor;
  if (alone) anchor = best.back();
  const auto captionOf = [&](const PointSummary& p) {
    return fmt::format("Point {}: {}; relMSE {}, first picture {} ms", p.point, p.label, shortNumber(p.relMse.mean),
                       plainNumber(p.firstPictureMs()));
  };
  const auto nearestPeer = [&](auto&& distance) -> const PeerRow* {
    const PeerRow* nearest = nullptr;
    for (const PeerRow& p : peers)
      if (p.relMse > 0 && p.seconds > 0 && (!nearest || distance(p) < distance(*nearest))) nearest = &p;
    return nearest;
  };
  const auto row = [&](const std::string& title, std::optional<size_t> other, const PeerRow* peer) {
    std::string out = fmt::format("<h3>{}</h3>\n<div class=\"crops\">\n", title);
    out += reportCrop(folder, kReferenceName, "Reference", notes);
    out += reportCrop(folder, pictureName(*anchor), captionOf(points[*anchor]), notes);
    if (other) out += reportCrop(folder, pictureName(*other), captionOf(points[*other]), notes);
    if (peer)
      out += reportCrop(folder, pictureName(peer->name, peer->samples),
                        fmt::format("Path tracer, {} samples per pixel: relMSE {}, {} ms", peer->samples,
                                    shortNumber(peer->relMse), plainNumber(1e3 * peer->seconds)),
                        notes);
    return out + "</div>\n";
  };
  // Least error for no more time, and least time for no more error.
  std::optional<size_t> inTime, inError;
  if (!alone) {
    inTime = by[*anchor];
    for (const size_t i : best)
      if (!inError && pairs[i].error <= pairs[*anchor].error) inError = i;
  }
  std::string out =
      row("Equal time", inTime,
          nearestPeer([&](const PeerRow& p) { return std::abs(std::log(1e3 * p.seconds / pairs[*anchor].cost)); }));
  out += row("Equal error", inError,
             nearestPeer([&](const PeerRow& p) { return std::abs(std::log(p.relMse / pairs[*anchor].error)); }));
  return out;
}

}  // namespace

std::string errorPlot(const CostKind& cost, const std::vector<PointSummary>& points, const std::vector<PeerRow>& peers,
                      std::optional<size_t> given) {
  const std::vector<CostAndError> pairs = pairsOf(points, cost);
  const std::vector<std::optional<size_t>> by = dominators(pairs);
  PlotSeries onFront{"on the front", PlotStyle::Front, {}}, dominated{"dominated", PlotStyle::Dominated, {}},
      ours{"settings given", PlotStyle::Given, {}}, peer{"path tracer (CPU), samples per pixel", PlotStyle::Peer, {}};
  const char* kind = std::string_view(cost.name) == "build"     ? "setup"
                     : std::string_view(cost.name) == "relight" ? "relight"
                     : std::string_view(cost.name) == "frame"   ? "camera"
                                                                : "";
  for (const PointSummary& p : points) {
    const CostAndError& pair = pairs[p.point];
    if (!(pair.cost > 0) || !(pair.error > 0) || !std::isfinite(pair.cost)) continue;
    PlotPoint mark{pair.cost, pair.error, pair.cost, pair.cost, pair.error, pair.error, std::to_string(p.point), ""};
    if (const auto spread = p.gpu.find(kind); spread != p.gpu.end())
      mark.xLow = spread->second.p5, mark.xHigh = spread->second.p95;
    if (std::isfinite(p.relMse.half)) mark.yLow = pair.error - p.relMse.half, mark.yHigh = pair.error + p.relMse.half;
    mark.hint =
        fmt::format("{}: {}; relMSE {}, {}", p.point, p.label, shortNumber(pair.error), amount(cost, pair.cost));
    if (by[p.point]) mark.hint += fmt::format("; dominated by {}", named(points[*by[p.point]]));
    if (given && *given == p.point) ours.points.push_back({mark.x, mark.y, mark.x, mark.x, mark.y, mark.y, "", ""});
    (by[p.point] ? dominated : onFront).points.push_back(std::move(mark));
  }
  if (cost.time)
    for (const PeerRow& p : peers)
      if (p.relMse > 0 && p.seconds > 0)
        peer.points.push_back({1e3 * p.seconds, p.relMse, 1e3 * p.seconds, 1e3 * p.seconds, p.relMse, p.relMse,
                               fmt::format("{}", p.samples),
                               fmt::format("path tracer, {} samples per pixel: relMSE {}, {} ms", p.samples,
                                           shortNumber(p.relMse), plainNumber(1e3 * p.seconds))});
  return logPlot(cost.axis, "relMSE of 8 × 8 means", {onFront, dominated, ours, peer});
}

std::string stagePlot(const std::string& title, const std::string& kind, const std::vector<PointSummary>& points,
                      const std::vector<size_t>& chosen) {
  std::map<std::string, double> totals;
  for (const size_t i : chosen)
    if (const auto stages = points[i].stages.find(kind); stages != points[i].stages.end())
      for (const auto& [stage, spread] : stages->second) totals[stage] += spread.p50;
  std::vector<std::pair<double, std::string>> order;
  for (const auto& [stage, ms] : totals) order.emplace_back(-ms, stage);
  std::ranges::sort(order);
  constexpr size_t kNamed = 8;
  std::vector<std::string> names;
  for (size_t i = 0; i < std::min(order.size(), kNamed); ++i) names.push_back(order[i].second);
  const bool rest = order.size() > kNamed;
  if (rest) names.push_back(fmt::format("{} others", order.size() - kNamed));
  std::vector<Bar> bars;
  for (const size_t i : chosen) {
    Bar bar{fmt::format("{}: {}", i, points[i].label), std::vector<double>(names.size(), 0.0)};
    if (const auto stages = points[i].stages.find(kind); stages != points[i].stages.end())
      for (size_t s = 0; s < order.size(); ++s)
        if (const auto spread = stages->second.find(order[s].second); spread != stages->second.end())
          bar.parts[std::min(s, names.size() - 1)] += spread->second.p50;
    bars.push_back(std::move(bar));
  }
  return stackedBars(title, names, bars);
}

std::string stageFinding(const std::string& name, const std::string& kind, const std::vector<PointSummary>& points,
                         const std::vector<size_t>& chosen) {
  struct Time {
    double all = 0;
    std::string words;
  };
  std::vector<Time> times;
  for (const size_t i : chosen) {
    const auto stages = points[i].stages.find(kind);
    if (stages == points[i].stages.end()) continue;
    const double all = points[i].gpuMs(kind);
    double most = 0;
    std::string largest;
    for (const auto& [stage, spread] : stages->second)
      if (spread.p50 > most) most = spread.p50, largest = stage;
    if (!(most > 0)) continue;
    times.push_back(
        {all, fmt::format("{} ms at point {}, {:.0f} % of it {}", plainNumber(all), i, 100 * most / all, largest)});
  }
  if (times.empty()) return fmt::format("{}: nothing was timed.", name);
  const auto [cheapest, dearest] = std::ranges::minmax_element(times, {}, &Time::all);
  if (!(cheapest->all < dearest->all)) return fmt::format("{}: {}.", name, cheapest->words);
  return fmt::format("{}: {}; {}.", name, cheapest->words, dearest->words);
}

namespace {

/// One row per point: its number and settings, then what `cells` makes of it; a failure in words across `columns`.
template <class Cells>
std::string tableOf(const std::vector<PointSummary>& points, std::optional<size_t> given,
                    const std::vector<const char*>& columns, Cells&& cells) {
  std::string out = "<table>\n<tr><th>point</th><th class=\"name\">settings</th>";
  for (const char* column : columns) out += fmt::format("<th>{}</th>", column);
  out += "</tr>\n";
  const std::vector<std::optional<size_t>> by = dominators(pairsOf(points, costKinds().front()));
  for (const PointSummary& p : points) {
    out += fmt::format("<tr{}><td>{}</td><td class=\"name\">{}{}</td>",
                       !by[p.point] && p.seeds > 0 ? " class=\"front\"" : "", p.point, escapeXml(p.label),
                       given && *given == p.point ? " (given)" : "");
    if (p.failure.empty())
      for (const std::string& cell : cells(p)) out += fmt::format("<td>{}</td>", cell);
    else
      out += fmt::format("<td colspan=\"{}\" class=\"name\">{}</td>", columns.size(), escapeXml(p.failure));
    out += "</tr>\n";
  }
  return out + "</table>\n";
}

}  // namespace

std::string pointTables(const std::vector<PointSummary>& points, std::optional<size_t> given) {
  const auto cell = [](double value) { return std::isfinite(value) ? plainNumber(value) : std::string("–"); };
  const auto range = [&](const PointSummary& p, const char* kind) {
    const auto spread = p.gpu.find(kind);
    return spread == p.gpu.end()
               ? std::string("–")
               : fmt::format("{}–{}", plainNumber(spread->second.p5), plainNumber(spread->second.p95));
  };
  const std::vector<std::optional<size_t>> by = dominators(pairsOf(points, costKinds().front()));
  std::string out = "<h2>Errors of all points</h2>\n<p>Blue: on the front of error against first picture.</p>\n";
  const bool ofFacets = std::ranges::any_of(points, [](const PointSummary& p) { return !std::isnan(p.hRelMse.mean); });
  std::vector<const char*> columns{"relMSE", "±", "RMSE", "±", "mean error", "±", "PSNR, dB", "FLIP", "±"};
  if (ofFacets) columns.insert(columns.end(), {"relMSE of H", "±", "RMSE of H, W/m²", "±"});
  columns.insert(columns.end(), {"facets", "entries"});
  out += tableOf(points, given, columns, [&](const PointSummary& p) {
    std::vector<std::string> cells{cell(p.relMse.mean), cell(p.relMse.half),    cell(p.rmse.mean),
                                   cell(p.rmse.half),   cell(p.meanError.mean), cell(p.meanError.half),
                                   cell(p.psnr.mean),   cell(p.flip.mean),      cell(p.flip.half)};
    if (ofFacets)
      for (const MeanInterval& m : {p.hRelMse, p.hRmse}) {
        cells.push_back(cell(m.mean));
        cells.push_back(std::isnan(m.mean) ? "–" : cell(m.half));
      }
    cells.push_back(withThousands(static_cast<uint64_t>(p.facets)));
    cells.push_back(withThousands(static_cast<uint64_t>(p.entries)));
    return cells;
  });
  out += "<h2>Costs of all points</h2>\n";
  out += tableOf(points, given,
                 {"build, ms", "p5–p95", "wall", "relight, ms", "p5–p95", "frame, ms", "p5–p95", "matrix, MiB",
                  "device, MiB", "dominated by"},
                 [&](const PointSummary& p) {
                   const auto wall = p.wall.find("setup");
                   return std::vector<std::string>{cell(p.gpuMs("setup")),
                                                   range(p, "setup"),
                                                   cell(wall == p.wall.end() ? std::nan("") : wall->second.p50),
                                                   cell(p.gpuMs("relight")),
                                                   range(p, "relight"),
                                                   cell(p.gpuMs("camera")),
                                                   range(p, "camera"),
                                                   cell(p.matrixMib),
                                                   cell(p.deviceMib),
                                                   by[p.point] ? std::to_string(*by[p.point]) : "front"};
                 });
  return out;
}

ReportNotes readNotes(const fs::path& folder) {
  ReportNotes notes;
  const fs::path file = folder / "notes.json";
  std::ifstream in(file);
  if (!in) return notes;
  const auto saved = nlohmann::ordered_json::parse(in, nullptr, /*allow_exceptions=*/false);
  try {
    notes.facts = saved.at("facts").get<std::vector<std::string>>();
    const auto pair = [&](const char* name) {
      return glm::uvec2(saved.at(name).at(0).get<uint32_t>(), saved.at(name).at(1).get<uint32_t>());
    };
    notes.pictureSize = pair("picture"), notes.cropAt = pair("crop"), notes.cropSize = pair("crop_size");
  } catch (const nlohmann::json::exception& error) {
    throw InputError(fmt::format("{}: {}", file.string(), error.what()));
  }
  return notes;
}

std::string pictureName(size_t point) {
  return fmt::format("point-{:04}", point);
}
std::string pictureName(const std::string& peer, uint32_t samples) {
  return fmt::format("{}-{}", peer, samples);
}

std::vector<std::string> findings(const std::vector<PointSummary>& points, const std::vector<PeerRow>& peers,
                                  std::optional<size_t> given) {
  std::vector<std::string> out;
  for (const CostKind& cost : costKinds()) out.push_back(errorFinding(cost, points, peers, given));
  return out;
}

std::vector<size_t> frontOfFirstPictures(const std::vector<PointSummary>& points) {
  return front(pairsOf(points, costKinds().front()));
}

namespace {

double costOfStages(const StageCost& c) {
  return c.buildMs + c.relightMs + c.frameMs;
}

/// Errors beside milliseconds, stage by stage in the same colours.
struct SplitBars {
  std::vector<std::string> names;
  std::vector<Bar> errors, times;
};
SplitBars splitBars(const std::vector<SplitPoint>& splits, const std::vector<PointSummary>& points) {
  SplitBars out;
  const auto add = [&](const std::string& name, auto&& error, auto&& ms) {
    bool any = false;
    for (const SplitPoint& s : splits) any = any || error(s.split) != 0 || ms(s.split) > 0;
    if (!any) return;  // it would only fill the legend
    out.names.push_back(name);
    for (size_t i = 0; i < splits.size(); ++i) {
      out.errors[i].parts.push_back(error(splits[i].split));
      out.times[i].parts.push_back(ms(splits[i].split));
    }
  };
  for (const SplitPoint& s : splits) {
    const std::string label = fmt::format("{}: {}", s.point, points[s.point].label);
    out.errors.push_back({label, {}}), out.times.push_back({label, {}});
  }
  for (size_t stage = 0; stage < kErrorStages; ++stage)
    add(
        nameOf(static_cast<ErrorStage>(stage)),
        [&](const Attribution& a) { return a.stages[stage].presence.present ? a.stages[stage].step.mean : 0.0; },
        [&](const Attribution& a) { return costOfStages(a.stages[stage].cost); });
  add(
      "model", [](const Attribution& a) { return a.model.mean; }, [](const Attribution&) { return 0.0; });
  add(
      "other", [](const Attribution&) { return 0.0; }, [](const Attribution& a) { return costOfStages(a.other); });
  return out;
}

/// Of one point: the stage with the most error and its time, the one with the most time and its error.
std::string splitFinding(const SplitPoint& s) {
  const Attribution& a = s.split;
  double all = costOfStages(a.other);
  const StageError *wrong = nullptr, *slow = nullptr;
  for (const StageError& row : a.stages) {
    all += costOfStages(row.cost);
    if (row.presence.present && (!wrong || row.step.mean > wrong->step.mean)) wrong = &row;
    if (!slow || costOfStages(row.cost) > costOfStages(slow->cost)) slow = &row;
  }
  const auto error = [&](double value) {
    return a.asIs.mean > 0 ? fmt::format("{:.0f} %", 100 * value / a.asIs.mean) : shortNumber(value);
  };
  const auto time = [&](const StageError& row) {
    return fmt::format("{:.0f} % of {} ms", 100 * costOfStages(row.cost) / all, plainNumber(all));
  };
  std::string out = fmt::format("Point {}: of relMSE {} ± {} every stage ideal leaves {}", s.point,
                                shortNumber(a.asIs.mean), shortNumber(a.asIs.half), error(a.model.mean));
  if (wrong && wrong->step.mean > 0)
    out += fmt::format("; {} adds most, {}, and takes {}", nameOf(wrong->stage), error(wrong->step.mean), time(*wrong));
  if (slow && slow != wrong && costOfStages(slow->cost) > 0)
    out += fmt::format("; {} takes most, {}, and adds {}", nameOf(slow->stage), time(*slow),
                       slow->presence.present ? error(slow->step.mean) : "nothing that was measured");
  return out + ".";
}

std::string splitSection(const fs::path& folder, const std::vector<SplitPoint>& splits,
                         const std::vector<PointSummary>& points) {
  std::string out = "<h2>Errors beside milliseconds, by stage</h2>\n";
  if (splits.empty())
    return out + "<p>Not measured: --split N splits the errors of N points on the front of first pictures.</p>\n";
  for (const SplitPoint& s : splits) out += htmlFinding(splitFinding(s));
  const SplitBars bars = splitBars(splits, points);
  const std::string errors = stackedBars("relMSE of 8 × 8 means: what each stage adds along the chain", bars.names,
                                         bars.errors, "relMSE"),
                    times = stackedBars("ms of a rebuild, a relight and a frame", bars.names, bars.times);
  writeFile(folder / "split-errors.svg", errors);
  writeFile(folder / "split-times.svg", times);
  return out + errors + times +
         "<p>From pictures with every stage ideal (model: what they are off by) one error after the other is put back, "
         "in the legend's order; parts below 0 are not drawn. Other: passes of no stage alone. Pages of their own: "
         "split/point-…/report.html.</p>\n";
}

}  // namespace

void writeReport(const fs::path& folder, const SettingGrid& grid, const StudyResults& results, const ReportNotes& notes,
                 const std::vector<SplitPoint>& splits) {
  std::vector<std::string> names;
  std::vector<std::vector<std::string>> values;
  for (const Setting* setting : grid.swept()) names.emplace_back(setting->name);
  for (size_t point = 0; point < grid.size(); ++point) values.push_back(grid.values(point));
  const std::optional<size_t> given = grid.find(grid.base());
  const std::vector<PointSummary> points = summarize(results, grid.labels());
  writeFile(folder / "points.csv", pointsCsv(points, names, values));
  writeFile(folder / "stages.csv", stagesCsv(points));

  std::string html;
  const std::vector<std::string> sentences = findings(points, results.peers, given);
  for (size_t i = 0; i < costKinds().size(); ++i) {
    const CostKind& cost = costKinds()[i];
    const std::string plot = errorPlot(cost, points, results.peers, given);
    writeFile(folder / fmt::format("error-against-{}.svg", cost.name), plot);
    html += fmt::format("<h2>Error against {}</h2>\n{}{}", escapeXml(cost.axis), htmlFinding(sentences[i]), plot);
  }

  // The front by first picture, and the settings given.
  std::vector<size_t> chosen = frontOfFirstPictures(points);
  if (given && std::ranges::find(chosen, *given) == chosen.end() && points[*given].seeds > 0) chosen.push_back(*given);
  html +=
      "<h2>Where the milliseconds go</h2>\n<p>Medians per stage of the points on the front by first picture, cheapest "
      "first, and of the settings given.</p>\n";
  for (const auto& [kind, axis, name] : kTimeKinds) {
    const std::string plot = stagePlot(axis, kind, points, chosen);
    writeFile(folder / fmt::format("stages-{}.svg", kind), plot);
    html += htmlFinding(stageFinding(name, kind, points, chosen)) + plot;
  }
  html += splitSection(folder, splits, points);
  html += "<h2>Pictures</h2>\n" + crops(folder, points, results.peers, given, notes);
  html += pointTables(points, given);
  writeFile(folder / "report.html", htmlPage("What accuracy costs", notes.facts, html));
}

}  // namespace irad
