// Judges of what the thesis found, each as Claim::judge, and what they share.
#pragma once

#include <algorithm>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "gi/study/named.h"

namespace irad::claims {

Answer bruteForceDiffers(const NamedResults& r);
Answer bruteForceLosesBounces(const NamedResults& r);
Answer buildTakesSeconds(const NamedResults& r);
Answer buildTakesLongerThanAFrame(const NamedResults& r);
Answer timeIsCubicInResolution(const NamedResults& r);
Answer matrixIsCubicInResolution(const NamedResults& r);
Answer resolutionIsSubtle(const NamedResults& r);
Answer timeIsLinearInRows(const NamedResults& r);
Answer rowsQuietHardLight(const NamedResults& r);
Answer rowsDoLittleInAverageLight(const NamedResults& r);
Answer sdfIsTwiceAsFast(const NamedResults& r);
Answer sdfLosesNoQuality(const NamedResults& r);
Answer sdfWeakensShadows(const NamedResults& r);
Answer normalsMatterLittle(const NamedResults& r);
Answer octahedralIsBetterOnCurves(const NamedResults& r);
Answer voxelsAreMissing(const NamedResults& r);
Answer relightTakesTwoToFourMs(const NamedResults& r);
Answer bestLambda(const NamedResults& r);
Answer bestLambdaOfNormalizedRows(const NamedResults& r);
Answer blurPremultipliedIsBest(const NamedResults& r);
Answer premultiplyingMendsEdges(const NamedResults& r);
Answer edgeRemovalMendsEdges(const NamedResults& r);
Answer edgeRemovalTime(const NamedResults& r);
Answer edgeRemovalDarkensReflections(const NamedResults& r);
Answer writebackCostsAMultiple(const NamedResults& r);
Answer writebackFlickers(const NamedResults& r);
Answer writebackAddsLittle(const NamedResults& r);
Answer cyclesIsMatched(const NamedResults& r);
Answer eeveeIsFarOff(const NamedResults& r);

// ---- Shared: numbers in words, and figures of results; NotMeasured where they are not there ----

using Points = std::vector<std::pair<double, double>>;

inline Judgement agreesIf(bool agrees) {
  return agrees ? Judgement::Agrees : Judgement::Disagrees;
}
std::string percent(double share);
std::string signedPercent(double share);
std::string withInterval(const MeanInterval& m);
/// Median milliseconds of the stages whose names begin so; of all stages.
double stageMs(const PointSummary& p, const char* kind, std::string_view prefix);
double kindMs(const PointSummary& p, const char* kind);
double figureOf(const ExperimentResult& e, const std::string& name);
double meanOf(const std::vector<double>& values);
/// Experiments that were measured and whose names end so.
std::vector<const ExperimentResult*> ending(const NamedResults& r, std::string_view suffix);
/// All that were measured.
std::vector<const ExperimentResult*> allMeasured(const NamedResults& r);
/// The thesis speaks of its GPU at full size; other machines' milliseconds say nothing about those.
const char* caveat(const NamedResults& r);
bool comparableTimes(const NamedResults& r);
/// Of how times grow: small sizes are mostly what every size costs.
Judgement atFullSize(const NamedResults& r, bool agrees);
/// "box 12 ms, park 20 ms"
std::string listed(const std::vector<std::pair<std::string, double>>& times);

/// (value of `setting`, what `of` says) of all points that were computed, by value.
template <class Of>
Points over(const ExperimentResult& e, const char* setting, Of&& of) {
  Points out;
  for (const MeasuredPoint& point : e.points)
    if (const auto value = point.settings.find(setting); value != point.settings.end() && point.summary.seeds > 0)
      out.emplace_back(std::stod(value->second), of(point.summary));
  if (out.size() < 2) throw NotMeasured(e.experiment.name + ": fewer than two values of " + setting);
  std::ranges::sort(out);
  return out;
}

}  // namespace irad::claims
