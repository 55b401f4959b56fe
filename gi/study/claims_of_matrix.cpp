// What experiments say to the thesis: brute force, build, resolution, rows, traversal (RQ2 to RQ6).
// Each sentence and verdict is computed. Where the thesis judged pictures by eye, FLIP decides. The bounds that words
// like "almost linear" are given stand in the sentence.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>

#include "gi/study/claims.h"
#include "gi/study/plot.h"
#include "renderer/base/number_text.h"

namespace irad::claims {

// ---- RQ2 ----

namespace {

/// Brute force of the most frames.
const PointSummary& converged(const ExperimentResult& e) {
  const PointSummary* most = nullptr;
  double frames = 0;
  for (const MeasuredPoint& point : e.points) {
    const auto method = point.settings.find("solver.method"), count = point.settings.find("solver.frames");
    if (method == point.settings.end() || method->second != "brute_force" || count == point.settings.end()) continue;
    if (std::stod(count->second) > frames) frames = std::stod(count->second), most = &point.summary;
  }
  if (!most || most->seeds == 0) throw NotMeasured(fmt::format("{}: brute force", e.experiment.name));
  return *most;
}
const PointSummary& bySweeps(const ExperimentResult& e, const char* sweeps) {
  return pointOf(e, {{"solver.method", "matrix"}, {"solver.max_sweeps", sweeps}});
}

}  // namespace

Answer bruteForceDiffers(const NamedResults& r) {
  std::vector<std::string> parts;
  bool differs = false;
  for (const ExperimentResult* e : ending(r, "-thesis")) {
    const PointSummary &matrix = bySweeps(*e, "1000"), &brute = converged(*e);
    const double light = e->light(brute) / e->light(matrix) - 1;
    if (!std::isfinite(light)) throw NotMeasured(fmt::format("{}: no mean light", e->experiment.name));
    differs = differs || std::abs(light) > .02;
    parts.push_back(fmt::format(
        "{}: brute force at its most frames ({}) has {} of the matrix's mean light, with relMSE {} "
        "against {}",
        e->experiment.name, brute.label, percent(1 + light), withInterval(brute.relMse), withInterval(matrix.relMse)));
  }
  return {agreesIf(differs),
          fmt::format("{}. {}", fmt::join(parts, "; "),
                      differs ? "They differ by more than 2 % of the light."
                              : "They agree within 2 % of the light: here each frame's rays bring the light of the "
                                "frame before, so that both solve the same equation.")};
}

Answer bruteForceLosesBounces(const NamedResults& r) {
  std::vector<std::string> parts;
  std::vector<double> lost;
  for (const ExperimentResult* e : ending(r, "-thesis")) {
    const double all = e->light(bySweeps(*e, "1000")), one = e->light(bySweeps(*e, "1"));
    const double first = e->light(pointOf(*e, {{"solver.method", "brute_force"}, {"solver.frames", "1"}}));
    lost.push_back(1 - one / all);
    if (!std::isfinite(lost.back())) throw NotMeasured(fmt::format("{}: no mean light", e->experiment.name));
    parts.push_back(fmt::format("{}: one bounce alone lacks {} of the light, one frame of brute force {}",
                                e->experiment.name, percent(lost.back()), percent(1 - first / all)));
  }
  const bool much = meanOf(lost) > .1;
  return {agreesIf(much),
          fmt::format("{}. So an accumulation that keeps to the first bounce {} (more than 10 %).",
                      fmt::join(parts, "; "), much ? "would differ plainly" : "would not differ plainly")};
}

// ---- RQ3 ----

namespace {

/// "box 12 ms (0.7 Mrays/s …)": build times by scene.
std::vector<std::pair<std::string, double>> buildTimes(const NamedResults& r, std::string_view suffix) {
  std::vector<std::pair<std::string, double>> out;
  for (const ExperimentResult* e : ending(r, suffix))
    out.emplace_back(e->experiment.scene, stageMs(pointOf(*e, {}), "setup", "GI BuildMatrix"));
  return out;
}

}  // namespace

Answer buildTakesSeconds(const NamedResults& r) {
  const auto times = buildTimes(r, "-thesis");
  const auto seconds = std::ranges::count_if(times, [](const auto& t) { return t.second >= 2000; });
  const std::string text = fmt::format(
      "By the thesis's settings the matrix takes {}{}: 2 s or more in {} of {} scenes. (Its Tables 6 to 9 "
      "themselves have 53 to 1109 ms.)",
      listed(times), caveat(r), seconds, times.size());
  if (!comparableTimes(r)) return {Judgement::Open, text};
  return {agreesIf(2 * seconds > static_cast<std::ptrdiff_t>(times.size())), text};
}

Answer buildTakesLongerThanAFrame(const NamedResults& r) {
  const auto thesis = buildTimes(r, "-thesis"), ours = buildTimes(r, "-ours");
  const auto slow = [](const auto& times) {
    return std::ranges::count_if(times, [](const auto& t) { return t.second > 1000.0 / 60; });
  };
  const std::string text = fmt::format(
      "Longer than a sixtieth of a second in {} of {} scenes by the thesis's settings, and in {} of {} by the present "
      "defaults ({}){}.",
      slow(thesis), thesis.size(), slow(ours), ours.size(), listed(ours), caveat(r));
  if (!comparableTimes(r)) return {Judgement::Open, text};
  return {agreesIf(2 * slow(thesis) > static_cast<std::ptrdiff_t>(thesis.size())), text};
}

// ---- RQ4 ----

Answer timeIsCubicInResolution(const NamedResults& r) {
  const ExperimentResult& e = experimentOf(r, "box-thesis");
  const double all = exponentOf(over(e, "voxel.resolution", [](const PointSummary& p) { return kindMs(p, "setup"); }));
  const double matrix = exponentOf(
      over(e, "voxel.resolution", [](const PointSummary& p) { return stageMs(p, "setup", "GI BuildMatrix"); }));
  return {atFullSize(r, all >= 2.5 && all <= 3.5),
          fmt::format("Set-up of the Box by the thesis's settings grows as N^{:.2f}, the matrix alone as N^{:.2f} "
                      "(almost cubic: 2.5 to 3.5). Facets lie on surfaces, of which there are N² times as many; only "
                      "the steps of their rays add a power{}.",
                      all, matrix, caveat(r))};
}

Answer matrixIsCubicInResolution(const NamedResults& r) {
  const ExperimentResult& e = experimentOf(r, "box-thesis");
  const double facets = exponentOf(over(e, "voxel.resolution", [](const PointSummary& p) { return p.facets; }));
  const double mib = exponentOf(over(e, "voxel.resolution", [](const PointSummary& p) { return p.matrixMib; }));
  std::string ours;
  try {
    ours = fmt::format("; the present format's as N^{:.2f}",
                       exponentOf(over(experimentOf(r, "box-ours"), "voxel.resolution",
                                       [](const PointSummary& p) { return p.matrixMib; })));
  } catch (const NotMeasured&) {
  }
  return {agreesIf(mib >= 2.5), fmt::format("Facets grow as N^{:.2f} and the padded matrix, whose rows are a power of "
                                            "two, as N^{:.2f}{} (cubic: 2.5 and more).",
                                            facets, mib, ours)};
}

Answer resolutionIsSubtle(const NamedResults& r) {
  std::vector<std::string> parts;
  bool subtle = true;
  for (const ExperimentResult* e : allMeasured(r)) {
    const Points errors = over(*e, "voxel.resolution", [](const PointSummary& p) { return p.relMse.mean; });
    const Points flips = over(*e, "voxel.resolution", [](const PointSummary& p) { return p.flip.mean; });
    parts.push_back(fmt::format("{}: from {:.0f} to {:.0f} voxels relMSE {} to {}, FLIP {} to {}", e->experiment.name,
                                errors.front().first, errors.back().first, shortNumber(errors.front().second),
                                shortNumber(errors.back().second), shortNumber(flips.front().second),
                                shortNumber(flips.back().second)));
    if (e->experiment.name.ends_with("-thesis")) subtle = subtle && flips.front().second < 1.5 * flips.back().second;
  }
  return {agreesIf(subtle), fmt::format("{}. {} (subtle: less than 1.5 times the FLIP).", fmt::join(parts, "; "),
                                        subtle ? "The thesis's settings gain little by voxels"
                                               : "By the thesis's settings voxels matter")};
}

// ---- RQ5 ----

Answer timeIsLinearInRows(const NamedResults& r) {
  const ExperimentResult& e = experimentOf(r, "average-thesis");
  const double build =
      exponentOf(over(e, "matrix.rays", [](const PointSummary& p) { return stageMs(p, "setup", "GI BuildMatrix"); }));
  const double solve =
      exponentOf(over(e, "matrix.rays", [](const PointSummary& p) { return stageMs(p, "relight", "GI Solve"); }));
  return {atFullSize(r, build >= .75 && build <= 1.25),
          fmt::format("The build grows as R^{:.2f} with rows of R places, the solver's sweeps as R^{:.2f} (almost "
                      "linear: 0.75 to 1.25 of the build){}.",
                      build, solve, caveat(r))};
}

namespace {

struct RowsFigures {
  NoiseFit fit;
  double flipFew, flipMany;  ///< FLIP at the shortest and longest rows
  double shortest, longest;
};
RowsFigures rowsOf(const NamedResults& r, std::string_view name) {
  const ExperimentResult& e = experimentOf(r, name);
  const Points squares = over(e, "matrix.rays", [](const PointSummary& p) { return p.rmse.mean * p.rmse.mean; });
  const Points flips = over(e, "matrix.rays", [](const PointSummary& p) { return p.flip.mean; });
  return {fitNoise(squares), flips.front().second, flips.back().second, squares.front().first, squares.back().first};
}

}  // namespace

Answer rowsQuietHardLight(const NamedResults& r) {
  const RowsFigures f = rowsOf(r, "hard-thesis");
  const ExperimentResult& e = experimentOf(r, "hard-thesis");
  const auto at = [&](double rays) -> const PointSummary& {
    return pointOf(e, {{"matrix.rays", fmt::format("{:.0f}", rays)}});
  };
  const PointSummary &few = at(f.shortest), &many = at(f.longest);
  const IntervalOrder order = compare(many.rmse, few.rmse);
  std::string text = fmt::format(
      "RMSE {} with {:.0f} places, {} with {:.0f}. By a fit of a + b/R to its square, {} of it is noise at "
      "{:.0f} and {} at {:.0f}.",
      withInterval(few.rmse), f.shortest, withInterval(many.rmse), f.longest, percent(f.fit.noiseShare(f.shortest)),
      f.shortest, percent(f.fit.noiseShare(f.longest)), f.longest);
  if (!r.measured("hard-ours").empty()) {
    const RowsFigures ours = rowsOf(r, "hard-ours");
    text += fmt::format(" By the present defaults these shares are {} and {}.",
                        percent(ours.fit.noiseShare(ours.shortest)), percent(ours.fit.noiseShare(ours.longest)));
  }
  if (order == IntervalOrder::Unknown) return {Judgement::Open, text + " One seed says nothing about noise."};
  return {agreesIf(order == IntervalOrder::Less), text};
}

Answer rowsDoLittleInAverageLight(const NamedResults& r) {
  const RowsFigures average = rowsOf(r, "average-thesis"), hard = rowsOf(r, "hard-thesis");
  const double gain = 1 - average.flipMany / average.flipFew, hardGain = 1 - hard.flipMany / hard.flipFew;
  return {agreesIf(gain < .1 && gain < hardGain),
          fmt::format(
              "From {:.0f} to {:.0f} places FLIP goes from {} to {} in average light ({}), and from {} to {} in "
              "hard light ({}) (unnoticeable: less than 10 %, and less than in hard light).",
              average.shortest, average.longest, shortNumber(average.flipFew), shortNumber(average.flipMany),
              signedPercent(-gain), shortNumber(hard.flipFew), shortNumber(hard.flipMany), signedPercent(-hardGain))};
}

// ---- RQ6 ----

namespace {

const PointSummary& traversed(const ExperimentResult& e, const char* traversal, const char* field) {
  std::map<std::string, std::string> wanted{{"matrix.traversal", traversal}};
  if (field) wanted["field.method"] = field;
  return pointOf(e, wanted);
}

}  // namespace

Answer sdfIsTwiceAsFast(const NamedResults& r) {
  std::vector<std::string> parts;
  std::vector<double> jfa, exact;
  for (const ExperimentResult* e : allMeasured(r)) {
    const double dda = stageMs(traversed(*e, "dda", nullptr), "setup", "GI BuildMatrix");
    jfa.push_back(dda / stageMs(traversed(*e, "sdf", "jfa"), "setup", "GI BuildMatrix"));
    exact.push_back(dda / stageMs(traversed(*e, "sdf", "chebyshev"), "setup", "GI BuildMatrix"));
    parts.push_back(fmt::format("{} {:.2f} and {:.2f}", e->experiment.scene, jfa.back(), exact.back()));
  }
  const double mean = meanOf(jfa);
  return {atFullSize(r, mean >= 1.5 && mean <= 2.5),
          fmt::format("The build is {:.2f} times as fast with the thesis's field on average, and {:.2f} times with the "
                      "exact one ({}){} (by 2: 1.5 to 2.5).",
                      mean, meanOf(exact), fmt::join(parts, ", "), caveat(r))};
}

Answer sdfLosesNoQuality(const NamedResults& r) {
  std::vector<std::string> parts;
  size_t worse = 0;
  bool known = true;
  for (const ExperimentResult* e : allMeasured(r)) {
    const PointSummary &dda = traversed(*e, "dda", nullptr), &jfa = traversed(*e, "sdf", "jfa"),
                       &exact = traversed(*e, "sdf", "chebyshev");
    const IntervalOrder order = compare(jfa.flip, dda.flip);
    known = known && order != IntervalOrder::Unknown;
    worse += order == IntervalOrder::More && jfa.flip.mean > 1.1 * dda.flip.mean ? 1 : 0;
    parts.push_back(fmt::format("{} {}, {}, {}", e->experiment.scene, withInterval(dda.flip), withInterval(jfa.flip),
                                withInterval(exact.flip)));
  }
  const std::string text = fmt::format(
      "FLIP cell by cell, with the thesis's field, with the exact one: {}. The thesis's field is worse (by more than "
      "a tenth and the intervals) in {} of {} scenes.",
      fmt::join(parts, "; "), worse, parts.size());
  return {known ? agreesIf(worse == 0) : Judgement::Open, text};
}

Answer sdfWeakensShadows(const NamedResults& r) {
  std::vector<std::string> parts;
  bool explained = true;
  double most = 0;
  for (const ExperimentResult* e : allMeasured(r)) {
    const PointSummary &dda = traversed(*e, "dda", nullptr), &jfa = traversed(*e, "sdf", "jfa"),
                       &exact = traversed(*e, "sdf", "chebyshev");
    const auto light = [&](const PointSummary& p) { return e->light(p) / e->light(dda) - 1; };
    const double moved = figureOf(*e, fmt::format("moved {}", jfa.point)),
                 movedExactly = figureOf(*e, fmt::format("moved {}", exact.point));
    explained = explained && moved > 10 * movedExactly;
    most = std::max(most, moved);
    parts.push_back(
        fmt::format("{}: {} of the rays end elsewhere with the thesis's field and {} with the exact one, "
                    "the mean light changes by {} and {}",
                    e->experiment.scene, percent(moved), percent(movedExactly), signedPercent(light(jfa)),
                    signedPercent(light(exact))));
  }
  return {explained && most > .01 ? Judgement::Answered : Judgement::Open,
          fmt::format("{}. {}", fmt::join(parts, "; "),
                      explained && most > .01
                          ? "An exact field changes next to nothing, so the cause is the thesis's field itself: "
                            "distances between cell centres in 8 bits, over which rays step past surfaces."
                          : "That does not tell the two fields apart.")};
}

}  // namespace irad::claims
