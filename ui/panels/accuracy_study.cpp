// The panel Accuracy: a study's front, and what the next millisecond would buy.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "ui/front_plot.h"
#include "ui/panels/accuracy_parts.h"
#include "ui/setting_rows.h"
#include "ui/theme.h"

namespace irad {
namespace {

/// "first picture": as points.csv has it, for the eye.
std::string nameOf(const CostKind& kind) {
  std::string name = kind.name;
  std::ranges::replace(name, '_', ' ');
  return name;
}
std::string costNumber(double value, const CostKind& kind) {
  return kind.time ? milliseconds(value) : fmt::format("{:.0f}", value);
}
std::string costText(double value, const CostKind& kind) {
  return fmt::format("{} {}", costNumber(value, kind), kind.unit);
}

std::string textOf(const PointSummary& p) {
  std::string out = fmt::format("point {}: {}\nrelMSE {}", p.point, p.label, shortNumber(p.relMse.mean));
  if (p.seeds > 1) out += fmt::format(" \u00B1 {} over {} seeds", shortNumber(p.relMse.half), p.seeds);
  for (const CostKind& kind : costKinds())
    if (const double value = kind.of(p); std::isfinite(value))
      out += fmt::format("\n{} {}", nameOf(kind), costText(value, kind));
  return out + "\nA click takes its settings.";
}

}  // namespace

void AccuracyStudy::find(const Session& session) {
  const LoadedStudy* study = session.accuracy.study ? &*session.accuracy.study : nullptr;
  misfit_ = session.accuracy.studyMisfit(session);
  if (!study || study->points.empty() || !misfit_.usable()) {
    place_.reset();
    return;
  }
  const uint64_t serial = session.accuracy.studies;
  if (placeIn_ == serial && placeOf_ == session.edited && place_) return;
  place_ = irad::placeOf(study->settings, study->measured(), session.edited);
  placeIn_ = serial;
  placeOf_ = session.edited;
}

void AccuracyStudy::draw(Session& session) {
  Accuracy& accuracy = session.accuracy;
  const float button = ImGui::CalcTextSize("Load").x + 2 * ImGui::GetStyle().FramePadding.x;
  ImGui::SetNextItemWidth(ImGui::GetContentRegionAvail().x - button - ImGui::GetStyle().ItemSpacing.x);
  const bool entered = ImGui::InputTextWithHint("##study", "folder of irad study cost", &accuracy.folder,
                                                ImGuiInputTextFlags_EnterReturnsTrue);
  helpTooltip("A folder that irad study cost or irad study attribution has written, or both one after the other");
  ImGui::SameLine();
  if (ImGui::Button("Load", {button, 0}) || entered) accuracy.wantStudy = true;
  helpTooltip("Reads the study in the folder on the left");
  if (accuracy.loading()) return ImGui::TextColored(theme::dim, "reading\u2026");
  if (!accuracy.studyError.empty()) return accuracyParagraph(theme::error, accuracy.studyError);
  if (!accuracy.study)
    return accuracyParagraph(theme::dim, "irad study cost measures what accuracy costs; load its folder.");
  const LoadedStudy& study = *accuracy.study;
  drawOrigin(session, study);
  if (!study.points.empty() && misfit_.usable()) drawFront(session, study);
}

/// What a study says holds for its scene, camera, size and device.
void AccuracyStudy::drawOrigin(Session& session, const LoadedStudy& study) const {
  if (!misfit_.scene.empty()) accuracyParagraph(theme::warning, fmt::format("Of another scene: {}.", misfit_.scene));
  if (!misfit_.camera.empty()) {
    accuracyParagraph(theme::warning, fmt::format("Of another camera: {}.", misfit_.camera));
    const std::optional<Camera> from = cameraOf(study);
    if (from && misfit_.scene.empty()) {
      if (ImGui::Button("Go to its camera", {-1, 0})) session.startAt(*from);
      helpTooltip("Looks from where the study was made, so that its figures hold");
    }
  }
  if (!misfit_.usable()) accuracyParagraph(theme::dim, "None of its figures are this picture's: they are not used.");
  if (!study.device.empty() && study.device != session.context.device.info.name)
    accuracyParagraph(theme::warning, fmt::format("Its times are of another device: {}.", study.device));
  if (misfit_.usable() && !misfit_.size.empty())
    accuracyParagraph(theme::dim,
                      fmt::format("Of pictures of {}: costs that grow with their size are not offered.", misfit_.size));
  if (!study.view.empty()) accuracyParagraph(theme::dim, fmt::format("Of the view {}.", study.view));
}

/// Of those that hold for the picture as it is.
const CostKind& AccuracyStudy::chooseCost() {
  const std::vector<CostKind>& kinds = costKinds();
  const auto holds = [&](const CostKind& kind) { return misfit_.size.empty() || !kind.ofPicture; };
  if (!holds(kinds[cost_])) cost_ = static_cast<size_t>(std::ranges::find_if(kinds, holds) - kinds.begin());
  fieldLabel("cost", "What the error is weighed against: the plot's horizontal axis");
  ImGui::PushID("cost");
  if (ImGui::BeginCombo("##", nameOf(kinds[cost_]).c_str())) {
    for (size_t i = 0; i < kinds.size(); ++i) {
      if (!holds(kinds[i])) continue;
      if (ImGui::Selectable(nameOf(kinds[i]).c_str(), i == cost_)) cost_ = i;
      helpTooltip(kinds[i].axis);
    }
    ImGui::EndCombo();
  }
  ImGui::PopID();
  return kinds[cost_];
}

void AccuracyStudy::drawFront(Session& session, const LoadedStudy& study) {
  const CostKind& kind = chooseCost();
  const std::vector<bool> measured = study.measured();
  std::vector<CostAndError> pairs(study.points.size());
  FrontPlot shown;
  for (size_t i = 0; i < pairs.size(); ++i) {
    const PointSummary& p = study.points[i];
    const double nan = std::numeric_limits<double>::quiet_NaN();
    pairs[i] = measured[i] ? CostAndError{kind.of(p), p.relMse.mean} : CostAndError{nan, nan};
    if (!(pairs[i].cost > 0) || !(pairs[i].error > 0)) continue;
    shown.points.push_back({.number = i, .at = pairs[i], .half = p.seeds > 1 ? p.relMse.half : 0, .text = textOf(p)});
  }
  if (shown.points.empty()) return accuracyParagraph(theme::dim, "No point of it has this cost and an error above 0.");
  const std::vector<size_t> onFront = front(pairs);
  for (FrontPlot::Point& p : shown.points) p.onFront = std::ranges::find(onFront, p.number) != onFront.end();
  shown.costUnit = kind.unit;
  if (place_) shown.here = place_->point, shown.exactly = place_->apart.empty();
  const FrontAnswer answer =
      frontPlot({ImGui::GetContentRegionAvail().x, std::floor(12 * ImGui::GetFontSize())}, shown);
  if (answer.clicked) take(session, study.settings[*answer.clicked]);
  drawPlace(study, kind, pairs);
  if (!before_) return;
  const bool goBack = ImGui::Button("Back to the settings before", {-1, 0});
  helpTooltip("As they were before a point of the plot was clicked");
  if (!goBack) return;
  const Settings back = *before_;
  take(session, back);
  before_.reset();
}

/// The edited settings, as if they had been typed; those of views, camera and seed stay.
void AccuracyStudy::take(Session& session, const Settings& from) {
  before_ = session.edited;
  for (const Setting& setting : settingTable())
    if (countsInStudies(setting)) setting.set(session.edited, setting.get(from));
}

void AccuracyStudy::drawPlace(const LoadedStudy& study, const CostKind& kind,
                              const std::vector<CostAndError>& pairs) const {
  if (!place_) return;
  const size_t at = place_->point;
  const CostAndError here = pairs[at];
  std::string where = fmt::format("{} point {}: relMSE {}, {}", place_->apart.empty() ? "Here:" : "Nearest:", at,
                                  shortNumber(here.error), costText(here.cost, kind));
  if (!place_->apart.empty()) {
    where += " (";
    for (size_t i = 0; i < place_->apart.size(); ++i) {
      if (i == 3) {
        where += fmt::format(", and {} more", place_->apart.size() - i);
        break;
      }
      where += (i > 0 ? ", " : "") + place_->apart[i];
    }
    where += ")";
  }
  accuracyParagraph(theme::text, where + ".");
  if (!(here.cost > 0) || !(here.error > 0)) return;
  const Slope slope = slopeAt(pairs, at);
  const auto point = [&](size_t i) { return fmt::format("point {}, {}", i, study.points[i].label); };
  if (slope.better)
    accuracyParagraph(theme::warning,
                      fmt::format("Not on the front: relMSE {} for {} ({}).", shortNumber(pairs[*slope.better].error),
                                  costText(pairs[*slope.better].cost, kind), point(*slope.better)));
  if (!slope.next) {
    accuracyParagraph(theme::dim,
                      slope.better ? "No dearer point has less error still." : "No point of the study has less error.");
    return;
  }
  const CostAndError& next = pairs[*slope.next];
  const double more = next.cost - here.cost;
  std::string buys;
  if (more > 1)
    buys =
        fmt::format("+1 {} buys {} of the error; ", kind.unit, sharePercent(1 - slope.errorFor(here, 1) / here.error));
  const PointSummary &a = study.points[at], &b = study.points[*slope.next];
  const bool unsure = a.seeds > 1 && b.seeds > 1 && here.error - a.relMse.half < next.error + b.relMse.half;
  accuracyParagraph(theme::text, fmt::format("{}{} {} more: relMSE {} {} {} ({}){}.", buys, costNumber(more, kind),
                                             kind.unit, shortNumber(here.error), arrowGlyph(), shortNumber(next.error),
                                             point(*slope.next), unsure ? "; their intervals overlap" : ""));
}

}  // namespace irad
