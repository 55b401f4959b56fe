// The panel Accuracy: the error as it is now.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "ui/metric_rows.h"
#include "ui/panels/accuracy_parts.h"
#include "ui/setting_rows.h"
#include "ui/theme.h"
#include "ui/words.h"

namespace irad {
namespace {

void drawBound(const Session& session) {
  const SolveReport& report = session.built->solve;
  const bool frames = report.frames > 0;
  const double bound = frames ? report.standardError : report.bound;
  const bool known = std::isfinite(bound) && report.meanH > 0;
  valueRow(frames ? "standard error" : "solver's bound",
           known ? fmt::format("{} of mean H", sharePercent(bound / report.meanH)) : "\u2014");
  helpTooltip([&] {
    return (known ? withDigits(bound) + " W/m\u00B2. " : std::string()) +
           (frames ? "Of the indirect irradiance H by brute force, as a share of its mean: known without a reference"
                   : "No facet's radiosity B is further from the solution of its matrix than this share of the mean H. "
                     "Known without a reference; it covers what sweeps are left alone, not the errors of rays, voxels "
                     "or lookups.");
  });
}

/// What is known of the noise of finitely many rays.
void drawNoise(const Session& session, const PlaceInStudy* place) {
  if (session.built->solve.frames > 0) return;  // drawBound() has it
  std::string text = "\u2014";
  if (const auto& comparison = session.comparison; comparison && comparison->result) {
    Settings other = comparison->other.edited;
    other.matrix.gpu.seed = session.edited.matrix.gpu.seed;
    if (other == session.edited && comparison->other.edited.matrix.gpu.seed != session.edited.matrix.gpu.seed)
      text = fmt::format("relMSE {} (A, B)", withDigits(comparison->result->picture.blockRelMse / 2));
  }
  if (text == "\u2014" && place != nullptr) {
    const PointSummary& p = session.accuracy.study->points[place->point];
    if (p.seeds > 1) text = fmt::format("\u00B1 {}, {} seeds", withDigits(p.relMse.half), p.seeds);
  }
  valueRow("rays' noise", text);
  helpTooltip(
      "How far relMSE would vary with other random rays. One picture does not show that: it is known from a study "
      "(half of the 95 % interval of relMSE over seeds, of the point nearest to these settings), or from a comparison "
      "of two seeds (half of the relMSE between them).");
}

void drawDominating(const Session& session) {
  const Accuracy& accuracy = session.accuracy;
  if (accuracy.study && !accuracy.study->stages.empty() && accuracy.studyMisfit(session).usable()) {
    const std::vector<StageShare>& stages = accuracy.study->stages;
    valueRow("largest part", fmt::format("{}, {}", stages[0].stage, withDigits(stages[0].relMse)));
    std::string all =
        "relMSE by stage, of the attribution.csv that was loaded (what is gained where it alone is ideal; model: "
        "what is left where all are):";
    for (const StageShare& stage : stages) all += fmt::format("\n{}  {}", withDigits(stage.relMse), stage.stage);
    helpTooltip(all);
    return;
  }
  const SolveReport& report = session.built->solve;
  std::string text = "\u2014";
  if (accuracy.measured && report.frames == 0 && report.meanH > 0 && accuracy.measured->blockRelMse > 0) {
    const double relative = report.bound / report.meanH, share = relative * relative / accuracy.measured->blockRelMse;
    text = !(share < 0.5) ? "sweeps, by the bound" : fmt::format("not sweeps (< {:.2g} %)", 100 * std::max(share, .01));
  }
  valueRow("largest part", text);
  helpTooltip(
      "The stage that most of the error comes from. Without an attribution.csv in the study's folder (made by irad "
      "study "
      "attribution) the window can only tell whether it is the solver's sweeps: the square of its bound over the mean "
      "H, against relMSE. The rest comes from voxels, rays, lookups and shadows.");
}

}  // namespace

void accuracyParagraph(const ImVec4& color, const std::string& text) {
  ImGui::PushStyleColor(ImGuiCol_Text, color);
  ImGui::PushTextWrapPos(0);
  ImGui::TextUnformatted(text.c_str());
  ImGui::PopTextWrapPos();
  ImGui::PopStyleColor();
}

std::string sharePercent(double share) {
  return share >= 0.0995 ? fmt::format("{:.0f} %", 100 * share) : fmt::format("{} %", withDigits(100 * share));
}

std::string nameOfView(View view) {
  const ViewInfo* info = viewInfo(view);
  return info != nullptr ? info->name : "?";
}

void drawError(Session& session, const PlaceInStudy* place) {
  const Accuracy& accuracy = session.accuracy;
  if (accuracy.measured) {
    const ViewInfo* info = viewInfo(session.reference->of);
    const std::string covers =
        accuracy.ofComputed() ? "\n\u00B1 is half of a 95 % interval by the reference's own noise. It does not cover "
                                "the noise of the rays, which one picture cannot show."
                              : "\nA reference from a file does not say its noise: there is no interval.";
    for (const MetricRow& row :
         metricRows(*accuracy.measured, "picture", "reference", info != nullptr ? prettyUnit(info->unit) : "")) {
      const bool headline = std::string_view(row.name) == "relMSE", flip = std::string_view(row.name) == "FLIP";
      if (std::string_view(row.name) == "largest") continue;  // which is the reference's noise
      if (flip && !std::isfinite(accuracy.measured->flip)) {
        fieldLabel(row.name, row.help);
        if (ImGui::Button("Measure###flip", {-1, 0})) session.accuracy.wantFlip = true;
        continue;
      }
      valueRow(row.name, row.text + (headline && !accuracy.fresh ? " \u2026" : ""));
      helpTooltip(row.help + (headline ? covers : "\nIt contains the reference's own noise."));
    }
  } else {
    valueRow("relMSE", accuracy.unmeasured.empty() ? "\u2026" : "\u2014");
    helpTooltip("Mean of (picture \u2212 reference)\u00B2 / (reference\u00B2 + \u03B5): not known yet");
    if (!accuracy.unmeasured.empty()) accuracyParagraph(theme::dim, accuracy.unmeasured + ".");
  }
  drawBound(session);
  drawNoise(session, place);
  drawDominating(session);
}

}  // namespace irad
