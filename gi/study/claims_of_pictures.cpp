// What experiments say to the thesis: normals, relight, λ, sampling, edges, writeback (RQ7 to RQ12), Cycles (RQ1).
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

// ---- RQ7 ----

namespace {

const PointSummary& encoded(const ExperimentResult& e, const char* encoding) {
  return pointOf(e, {{"voxel.normals", encoding}});
}
std::string encodings(const ExperimentResult& e) {
  std::vector<std::string> out;
  for (const MeasuredPoint& p : e.points)
    if (p.summary.seeds > 0)
      out.push_back(fmt::format("{} {}", p.settings.at("voxel.normals"), withInterval(p.summary.flip)));
  return fmt::format("{}: {}", e.experiment.name, fmt::join(out, ", "));
}

}  // namespace

Answer normalsMatterLittle(const NamedResults& r) {
  const ExperimentResult& e = experimentOf(r, "box-thesis");
  double least = HUGE_VAL, most = 0;
  for (const char* encoding : {"axis6", "axis26", "oct8"}) {
    const double value = encoded(e, encoding).flip.mean;
    least = std::min(least, value), most = std::max(most, value);
  }
  return {agreesIf(most < 1.25 * least),
          fmt::format("FLIP by encoding, {}: the worst of the thesis's three has {:.2f} times the error of the best "
                      "(hardly: less than 1.25).",
                      encodings(e), most / least)};
}

Answer octahedralIsBetterOnCurves(const NamedResults& r) {
  const ExperimentResult& e = experimentOf(r, "curved-thesis");
  const IntervalOrder order = compare(encoded(e, "oct8").flip, encoded(e, "axis26").flip);
  std::string text = fmt::format("FLIP by encoding, {}", encodings(e));
  for (const ExperimentResult* ours : r.measured("curved-ours")) text += "; " + encodings(*ours);
  text += order == IntervalOrder::Less    ? ". Octahedral normals are better than axes."
          : order == IntervalOrder::More  ? ". Octahedral normals are worse than axes."
          : order == IntervalOrder::Equal ? ". Octahedral normals and axes cannot be told apart."
                                          : ". One seed does not tell them apart.";
  return {order == IntervalOrder::Unknown ? Judgement::Open : agreesIf(order == IntervalOrder::Less), text};
}

Answer voxelsAreMissing(const NamedResults& r) {
  const ExperimentResult& e = experimentOf(r, "voxels-thesis");
  const PointSummary &raster = pointOf(e, {{"voxel.method", "raster"}, {"thesis.literal", "false"}}),
                     &whole = pointOf(e, {{"voxel.method", "conservative"}, {"thesis.literal", "false"}}),
                     &literal = pointOf(e, {{"voxel.method", "raster"}, {"thesis.literal", "true"}});
  const double missing = 1 - raster.facets / whole.facets, slips = 1 - literal.facets / raster.facets;
  const bool found = missing > .001 || std::abs(slips) > .001;
  return {found ? Judgement::Answered : Judgement::Open,
          fmt::format("Rasterization along dominant axes finds {:.0f} solid voxels where {:.0f} are touched: {} are "
                      "missing, since it looks at pixel centres alone. The slips as published (thesis.literal) make it "
                      "{:.0f}, {} fewer. FLIP: {}, {} with all voxels, {} with the slips.",
                      raster.facets, whole.facets, percent(missing), literal.facets, percent(slips),
                      withInterval(raster.flip), withInterval(whole.flip), withInterval(literal.flip))};
}

// ---- RQ8 ----

Answer relightTakesTwoToFourMs(const NamedResults& r) {
  const auto listOf = [&](std::string_view suffix, const char* sweeps, std::vector<double>* values) {
    std::vector<std::pair<std::string, double>> out;
    for (const ExperimentResult* e : ending(r, suffix)) {
      out.emplace_back(e->experiment.scene, kindMs(pointOf(*e, {{"solver.max_sweeps", sweeps}}), "relight"));
      if (values) values->push_back(out.back().second);
    }
    return listed(out);
  };
  std::vector<double> ms;
  const std::string one = listOf("-thesis", "1", &ms);
  const double mean = meanOf(ms);
  const std::string text = fmt::format(
      "One iteration (shadows, gather, a sweep, scatter) by the thesis's settings takes {} ms on average: {}{}; until "
      "the light has settled: {}; by the present defaults: {}.",
      plainNumber(mean), one, caveat(r), listOf("-thesis", "1000", nullptr), listOf("-ours", "1000", nullptr));
  if (!comparableTimes(r)) return {Judgement::Open, text};
  return {agreesIf(mean >= 2 && mean <= 4), text};
}

// ---- RQ9 ----

namespace {

struct BestLambda {
  std::string text;
  std::vector<double> best;  ///< by FLIP, as the thesis judged by eye
};
BestLambda bestLambdas(const NamedResults& r, std::string_view suffix) {
  BestLambda out;
  std::vector<std::string> parts;
  for (const ExperimentResult* e : ending(r, suffix)) {
    const auto least = [&](auto&& of) {
      const Points errors = over(*e, "solver.lambda", of);
      const double best = leastAt(errors);
      const char* end = best == errors.front().first  ? ", the lowest tried"
                        : best == errors.back().first ? ", the highest tried"
                                                      : "";
      return std::pair(best, fmt::format("{:.2f}{}", best, end));
    };
    const auto flip = least([](const PointSummary&p) { return p.flip.mean; }),
               relMse = least([](const PointSummary&p) { return p.relMse.mean; });
    out.best.push_back(flip.first);
    const PointSummary &given = pointOf(*e, {{"solver.lambda", "0.8"}}), &one = pointOf(*e, {{"solver.lambda", "1"}});
    parts.push_back(fmt::format("{} {} by FLIP ({} at 0.8, {} at 1) and {} by relMSE ({} at 0.8, {} at 1)",
                                e->experiment.scene, flip.second, withInterval(given.flip), withInterval(one.flip),
                                relMse.second, withInterval(given.relMse), withInterval(one.relMse)));
  }
  out.text = fmt::format("{}", fmt::join(parts, "; "));
  return out;
}

}  // namespace

Answer bestLambda(const NamedResults& r) {
  const BestLambda b = bestLambdas(r, "-thesis");
  const auto within = std::ranges::count_if(b.best, [](double x) { return x >= .6 && x <= .9; });
  return {agreesIf(within == static_cast<std::ptrdiff_t>(b.best.size())),
          fmt::format("Against the path tracer, by the thesis's settings, error is least at λ = {}. By FLIP within 0.6 "
                      "to 0.9 in {} of {} scenes.",
                      b.text, within, b.best.size())};
}

Answer bestLambdaOfNormalizedRows(const NamedResults& r) {
  const BestLambda thesis = bestLambdas(r, "-thesis"), ours = bestLambdas(r, "-ours");
  const bool one = std::ranges::all_of(ours.best, [](double x) { return x > .95; });
  const bool less = std::ranges::any_of(thesis.best, [](double x) { return x <= .95; });
  return {Judgement::Answered,
          fmt::format("With rows that are divided by the rays that count, and rays that meet triangles, error is least "
                      "at λ = {}. {}",
                      ours.text,
                      one && less ? "There the physics' own value, 1, is the best: what λ < 1 makes up for is the "
                                    "thesis's model, not the solver."
                      : one       ? "So it is with the thesis's settings: λ < 1 gains nothing."
                                  : "Even there it is not 1.")};
}

// ---- RQ10 ----

namespace {

const PointSummary& mode(const ExperimentResult& e, const char* filter, const char* premultiplied) {
  return pointOf(e, {{"sample.filter", filter}, {"sample.premultiplied", premultiplied}});
}

}  // namespace

Answer blurPremultipliedIsBest(const NamedResults& r) {
  std::vector<std::string> parts;
  size_t best = 0;
  const std::vector<const ExperimentResult*> all = ending(r, "-thesis");
  for (const ExperimentResult* e : all) {
    const double ours = mode(*e, "blur", "true").flip.mean;
    double least = HUGE_VAL;
    std::vector<std::string> values;
    for (const char* filter : {"linear", "blur"})
      for (const char* premultiplied : {"false", "true"}) {
        const MeanInterval& m = mode(*e, filter, premultiplied).flip;
        least = std::min(least, m.mean);
        values.push_back(
            fmt::format("{}{} {}", filter, *premultiplied == 't' ? " premultiplied" : "", withInterval(m)));
      }
    best += ours <= least ? 1 : 0;
    parts.push_back(fmt::format("{}: {}", e->experiment.name, fmt::join(values, ", ")));
  }
  return {agreesIf(best == all.size()), fmt::format("FLIP, {}. Blurred and premultiplied is the best in {} of {}.",
                                                    fmt::join(parts, "; "), best, all.size())};
}

Answer premultiplyingMendsEdges(const NamedResults& r) {
  std::vector<std::string> parts;
  bool mends = true;
  for (const ExperimentResult* e : ending(r, "-thesis")) {
    const PointSummary &without = mode(*e, "blur", "false"), &with = mode(*e, "blur", "true");
    const double light = e->light(without) / e->light(with) - 1;
    mends = mends && light < -.02 && compare(with.flip, without.flip) != IntervalOrder::More;
    parts.push_back(fmt::format("{}: {} of the mean light without it, FLIP {} instead of {}", e->experiment.name,
                                signedPercent(light), withInterval(without.flip), withInterval(with.flip)));
  }
  return {agreesIf(mends), fmt::format("{}. {} (darker by more than 2 %, and no less error).", fmt::join(parts, "; "),
                                       mends ? "Without it pictures are darker" : "Not everywhere")};
}

// ---- RQ11 ----

Answer edgeRemovalMendsEdges(const NamedResults& r) {
  std::vector<std::string> parts;
  size_t better = 0;
  bool known = true;
  for (const ExperimentResult* e : ending(r, "-thesis")) {
    const PointSummary &off = pointOf(*e, {{"scatter.edge_removal", "false"}}),
                       &on = pointOf(*e, {{"scatter.edge_removal", "true"}});
    const IntervalOrder order = compare(on.flip, off.flip);
    better += order == IntervalOrder::Less ? 1 : 0;
    known = known && order != IntervalOrder::Unknown;
    const double truth = figureOf(*e, "truth_mean");
    parts.push_back(fmt::format("{}: FLIP {} with it, {} without; mean light {} of the truth instead of {}",
                                e->experiment.name, withInterval(on.flip), withInterval(off.flip),
                                percent(e->light(on) / truth), percent(e->light(off) / truth)));
  }
  return {known ? agreesIf(2 * better > parts.size()) : Judgement::Open,
          fmt::format("{}. Pictures are nearer to the truth with it in {} of {} scenes.", fmt::join(parts, "; "),
                      better, parts.size())};
}

Answer edgeRemovalTime(const NamedResults& r) {
  std::vector<std::string> parts;
  for (const ExperimentResult* e : ending(r, "-thesis")) {
    const auto ms = [&](const char* on) {
      return stageMs(pointOf(*e, {{"scatter.edge_removal", on}}), "relight", "GI Scatter");
    };
    const double off = ms("false"), on = ms("true");
    parts.push_back(fmt::format("{} {} ms instead of {}, {:.2f} times", e->experiment.scene, plainNumber(on),
                                plainNumber(off), on / off));
  }
  return {Judgement::Answered, fmt::format("The scatter takes {}{}.", fmt::join(parts, "; "), caveat(r))};
}

Answer edgeRemovalDarkensReflections(const NamedResults& r) {
  const ExperimentResult& e = experimentOf(r, "reflections");
  const double change = e.light(pointOf(e, {{"scatter.edge_removal", "true"}})) /
                            e.light(pointOf(e, {{"scatter.edge_removal", "false"}})) -
                        1;
  if (!std::isfinite(change)) throw NotMeasured("reflections: no mean light");
  return {agreesIf(change < -.02),
          fmt::format("The mean of reflections changes by {}.{}", signedPercent(change),
                      std::abs(change) < .001 ? " Here they read the facets' light, not the volume that edge removal "
                                                "changes: the trade-off is one of where reflections look."
                                              : "")};
}

// ---- RQ12 ----

namespace {

const PointSummary& written(const ExperimentResult& e, const char* mode) {
  return pointOf(e, {{"writeback.mode", mode}});
}

}  // namespace

Answer writebackCostsAMultiple(const NamedResults& r) {
  std::vector<std::string> parts;
  std::vector<double> factors;
  for (const ExperimentResult* e : allMeasured(r)) {
    const double off = kindMs(written(*e, "off"), "camera"), mask = kindMs(written(*e, "mask"), "camera");
    const double compute = kindMs(written(*e, "compute"), "camera");
    factors.push_back(mask / off);
    parts.push_back(fmt::format(
        "{}: a picture takes {} ms without, {} ms ({:.2f} times) by the mask and {} ms ({:.2f} "
        "times) by the mean over pixels",
        e->experiment.name, plainNumber(off), plainNumber(mask), mask / off, plainNumber(compute), compute / off));
  }
  return {
      atFullSize(r, meanOf(factors) >= 2),
      fmt::format(
          "{}{} (several times: 2 and more, by the mask). The thesis's Tables 7 and 10 have medians of 0.375 and 3.39 "
          "ms of RE Forward.",
          fmt::join(parts, "; "), caveat(r))};
}

Answer writebackFlickers(const NamedResults& r) {
  std::vector<std::string> parts;
  double most = 0;
  for (const ExperimentResult* e : allMeasured(r)) {
    const double mask = figureOf(*e, fmt::format("flicker {}", written(*e, "mask").point)),
                 compute = figureOf(*e, fmt::format("flicker {}", written(*e, "compute").point));
    most = std::max(most, mask);
    parts.push_back(
        fmt::format("{}: with a still camera facets' light changes from picture to picture by {:.2g} % of "
                    "its mean with the mask and by {:.2g} % with the mean over pixels; relMSE over seeds "
                    "{} and {}",
                    e->experiment.name, 100 * mask, 100 * compute, withInterval(written(*e, "mask").relMse),
                    withInterval(written(*e, "compute").relMse)));
  }
  return {r.cpu ? Judgement::Open : agreesIf(most > .001),
          fmt::format("{} (flicker: more than 0.1 %).{}", fmt::join(parts, "; "),
                      r.cpu ? " CPU devices take pixels in a fixed order, so that the mask's races have one outcome "
                              "here: a GPU has to tell."
                            : "")};
}

Answer writebackAddsLittle(const NamedResults& r) {
  std::vector<std::string> parts;
  double most = 0;
  for (const ExperimentResult* e : allMeasured(r)) {
    const double off = e->light(written(*e, "off"));
    const double mask = e->light(written(*e, "mask")) / off - 1, compute = e->light(written(*e, "compute")) / off - 1;
    if (!std::isfinite(mask)) throw NotMeasured(fmt::format("{}: no mean light", e->experiment.name));
    most = std::max(most, std::abs(mask));
    parts.push_back(
        fmt::format("{}: the picture's mean changes by {} with the mask and by {} with the mean over "
                    "pixels",
                    e->experiment.name, signedPercent(mask), signedPercent(compute)));
  }
  return {agreesIf(most < .05), fmt::format("{} (little: less than 5 % by the mask).", fmt::join(parts, "; "))};
}

// ---- RQ1 ----

Answer cyclesIsMatched(const NamedResults& r) {
  std::vector<std::string> parts;
  std::vector<double> off;
  for (const ExperimentResult* e : allMeasured(r)) {
    const std::string_view name = e->experiment.name;
    if (name.find("-eevee-") != name.npos) continue;
    const PointSummary& p = pointOf(*e, {});
    const double light = e->light(p) / figureOf(*e, "truth_mean") - 1;
    if (e->experiment.view == "lit" && !name.ends_with("-ours")) off.push_back(std::abs(light));
    parts.push_back(fmt::format("{}: mean radiance {} of Cycles', relMSE {}, FLIP {}", name, percent(1 + light),
                                withInterval(p.relMse), withInterval(p.flip)));
  }
  if (off.empty()) throw NotMeasured("no picture by Cycles");
  const double worst = *std::ranges::max_element(off);
  return {agreesIf(worst < .1),
          fmt::format("In linear radiance, {} (close: lit pictures within 10 % of the mean, by the thesis's settings).",
                      fmt::join(parts, "; "))};
}

Answer eeveeIsFarOff(const NamedResults& r) {
  std::vector<std::string> parts;
  bool far = true;
  for (const char* scene : {"box", "park"}) {
    const ExperimentResult &cycles = experimentOf(r, fmt::format("{}-cycles-lit", scene)),
                           &eevee = experimentOf(r, fmt::format("{}-eevee-lit", scene));
    const PointSummary& here = pointOf(cycles, {});
    const double light = figureOf(eevee, "truth_mean") / figureOf(eevee, "cycles_mean"),
                 flip = figureOf(eevee, "cycles_flip");
    far = far && light < .9 && flip > here.flip.mean + here.flip.half;
    parts.push_back(fmt::format(
        "{}: EEVEE's picture has {} of the mean radiance of Cycles' and FLIP {} to it, this "
        "program's by the thesis's settings {} and {}; from EEVEE's that is {} away",
        scene, percent(light), shortNumber(flip), percent(cycles.light(here) / figureOf(cycles, "truth_mean")),
        withInterval(here.flip), withInterval(pointOf(eevee, {}).flip)));
  }
  return {agreesIf(far), fmt::format("{} (far off: more than 10 % too dark, and further from Cycles by FLIP).",
                                     fmt::join(parts, "; "))};
}

}  // namespace irad::claims
