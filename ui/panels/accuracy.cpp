// How far the picture is from the truth and what it costs: the error as it is now, the reference that it is held
// against, milliseconds, a study's front with the settings as they are.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "gi/convergence.h"
#include "gi/study/front.h"
#include "gi/study/slope.h"
#include "ui/front_plot.h"
#include "ui/imgui.h"
#include "ui/metric_rows.h"
#include "ui/panel.h"
#include "ui/setting_rows.h"
#include "ui/theme.h"
#include "ui/widgets.h"

namespace irad {
namespace {

void paragraph(const ImVec4& color, const std::string& text) {
  ImGui::PushStyleColor(ImGuiCol_Text, color);
  ImGui::PushTextWrapPos(0);
  ImGui::TextUnformatted(text.c_str());
  ImGui::PopTextWrapPos();
  ImGui::PopStyleColor();
}

std::string secondsText(double seconds) {
  return seconds < 99.5 ? fmt::format("{:.0f} s", std::ceil(seconds)) : fmt::format("{:.0f} min", seconds / 60);
}

std::string sharePercent(double share) {
  return share >= 0.0995 ? fmt::format("{:.0f} %", 100 * share) : fmt::format("{} %", shortNumber(100 * share));
}

/// The kinds of work that a study weighs, as they run in the window.
enum class CostOf { Build, Relight, Frame };
CostOf workOf(const Timings::Row& row) {
  if (row.kind == WorkKind::Setup) return CostOf::Build;
  return row.stage.starts_with("GI ") || row.stage == "RE Shadow" ? CostOf::Relight : CostOf::Frame;
}

class AccuracyPanel : public Panel {
 public:
  const char* title() const override { return "Accuracy"; }
  Region region() const override { return Region::Right; }

  void draw(Session& session) override {
    session.accuracy.open = true;
    if (!session.built) {
      ImGui::TextColored(theme::dim, "no picture yet");
      return;
    }
    findPlace(session);
    drawError(session);
    drawReference(session);
    ImGui::Separator();
    drawTimes(session);
    ImGui::Separator();
    drawStudy(session);
  }

 private:
  size_t cost_ = 0;                    ///< of costKinds()
  std::optional<PlaceInStudy> place_;  ///< of the settings among the study's points
  uint64_t placeIn_ = 0;               ///< Accuracy::studies
  Settings placeOf_;
  std::optional<Settings> before_;  ///< settings before a point's were taken
  std::vector<Timings::Row> rows_;
  uint64_t rowsOf_ = UINT64_MAX;
  Refresh refresh_;

  // ---- Error now ----

  static std::string nameOfView(View view) {
    const ViewInfo* info = viewInfo(view);
    return info != nullptr ? info->name : "?";
  }

  void drawError(Session& session) {
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
          if (ImGui::Button("measure###flip", {-1, 0})) session.accuracy.wantFlip = true;
          continue;
        }
        valueRow(row.name, row.text + (headline && !accuracy.fresh ? " \u2026" : ""));
        helpTooltip(row.help + (headline ? covers : "\nIt contains the reference's own noise."));
      }
    } else {
      valueRow("relMSE", accuracy.unmeasured.empty() ? "\u2026" : "\u2014");
      if (!accuracy.unmeasured.empty()) paragraph(theme::dim, accuracy.unmeasured + ".");
    }
    drawBound(session);
    drawNoise(session);
    drawDominating(session);
  }

  static void drawBound(const Session& session) {
    const SolveReport& report = session.built->solve;
    const bool frames = report.frames > 0;
    const double bound = frames ? report.standardError : report.bound;
    const bool known = std::isfinite(bound) && report.meanH > 0;
    valueRow(
        frames ? "standard error" : "solver's bound",
        known ? fmt::format("{} W/m\u00B2, {}", shortNumber(bound), sharePercent(bound / report.meanH)) : "\u2014");
    helpTooltip(frames ? "Of H by brute force, and as a share of the mean H: known without a reference"
                       : "No facet's B is further from the solution of its matrix than this; as a share of the mean H. "
                         "Known without a reference; it covers sweeps alone, not rays, voxels or lookups");
  }

  /// What is known of the noise of finitely many rays.
  void drawNoise(const Session& session) const {
    if (session.built->solve.frames > 0) return;  // drawBound() has it
    std::string text = "\u2014";
    if (const auto& comparison = session.comparison; comparison && comparison->result) {
      Settings other = comparison->other.edited;
      other.matrix.gpu.seed = session.edited.matrix.gpu.seed;
      if (other == session.edited && comparison->other.edited.matrix.gpu.seed != session.edited.matrix.gpu.seed)
        text = fmt::format("relMSE {} (A, B)", shortNumber(comparison->result->picture.blockRelMse / 2));
    }
    if (text == "\u2014" && place_) {
      const PointSummary& p = session.accuracy.study->points[place_->point];
      if (p.seeds > 1) text = fmt::format("\u00B1 {}, {} seeds", shortNumber(p.relMse.half), p.seeds);
    }
    valueRow("rays' noise", text);
    helpTooltip(
        "One picture does not show the noise of its rays. It is known from a study (half of the 95 % interval of "
        "relMSE "
        "over seeds, of the point nearest to these settings), or from a comparison of two seeds (half of the relMSE "
        "between them).");
  }

  static void drawDominating(const Session& session) {
    const Accuracy& accuracy = session.accuracy;
    if (accuracy.study && !accuracy.study->stages.empty()) {
      const std::vector<StageShare>& stages = accuracy.study->stages;
      valueRow("largest part", fmt::format("{}, {}", stages[0].stage, shortNumber(stages[0].relMse)));
      std::string all =
          "relMSE by stage, of the attribution.csv that was loaded (what is gained where it alone is ideal; model: "
          "what is left where all are):";
      for (const StageShare& stage : stages) all += fmt::format("\n{}  {}", shortNumber(stage.relMse), stage.stage);
      helpTooltip(all);
      return;
    }
    const SolveReport& report = session.built->solve;
    std::string text = "\u2014";
    if (accuracy.measured && report.frames == 0 && report.meanH > 0 && accuracy.measured->blockRelMse > 0) {
      const double relative = report.bound / report.meanH, share = relative * relative / accuracy.measured->blockRelMse;
      text = !(share < 0.5) ? "sweeps, by the bound"
                            : fmt::format("not sweeps (< {})", sharePercent(std::max(share, .01)));
    }
    valueRow("largest part", text);
    helpTooltip(
        "Of the error. Without an attribution.csv in the study's folder (irad study attribution) the window knows but "
        "whether it is the sweeps: the square of the solver's bound over the mean H, against relMSE. The rest is "
        "voxels, rays, lookups and shadows.");
  }

  // ---- The reference ----

  void drawReference(Session& session) {
    Accuracy& accuracy = session.accuracy;
    ImGui::Separator();
    if (session.reference) {
      const ReferencePicture& reference = *session.reference;
      const glm::uvec2 size = reference.picture.size;
      std::string what = accuracy.traced() ? fmt::format("{} samples", accuracy.traced()->samples)
                                           : reference.path.filename().string();
      valueRow("reference", what);
      helpTooltip(fmt::format("{}\n{} \u00D7 {} pixels",
                              accuracy.traced() ? "Path traced here" : reference.path.string(), size.x, size.y));
      if (accuracy.traced()) {
        valueRow("its noise", shortNumber(accuracy.traced()->noise));
        helpTooltip(
            "\u221ArelMSE of its pixels by their own standard errors; in relMSE above it cancels but for \u00B1");
      }
      drawOf(session, reference);
      drawShow(session, reference);
    } else {
      paragraph(theme::dim, "Drop an .exr on the window, or compute one:");
    }
    drawTracing(session);
  }

  /// What the picture is of: for that of a file the user knows.
  static void drawOf(Session& session, const ReferencePicture& reference) {
    if (session.accuracy.traced()) {
      valueRow("of", nameOfView(reference.of));
      return;
    }
    fieldLabel("of", "The view that the file is a picture of: relMSE and the view error compare with that");
    ImGui::PushID("of");
    if (ImGui::BeginCombo("##", nameOfView(reference.of).c_str())) {
      for (const View view : {View{VIEW_LIT}, View{VIEW_INDIRECT}})
        if (ImGui::Selectable(nameOfView(view).c_str(), view == reference.of)) session.accuracy.referenceOf = view;
      ImGui::EndCombo();
    }
    ImGui::PopID();
  }

  static void drawShow(Session& session, const ReferencePicture& reference) {
    const bool split = session.split && !session.comparison;
    const char* shown = split                                    ? "split"
                        : session.view == VIEW_ERROR             ? "heat map"
                        : session.view == VIEW_REFERENCE_PICTURE ? "reference"
                        : session.view == reference.of           ? "picture"
                                                                 : "another view";
    fieldLabel("show", "The picture, the reference, both beside each other, or where they differ (the view error)");
    ImGui::PushID("show");
    if (ImGui::BeginCombo("##", shown)) {
      const auto entry = [&](const char* name, View view, bool splits) {
        if (!ImGui::Selectable(name, std::string_view(name) == shown)) return;
        session.view = view;
        session.split.reset();
        if (splits) session.split.emplace();
        session.viewDirty = true;
      };
      entry("picture", reference.of, false);
      entry("reference", VIEW_REFERENCE_PICTURE, false);
      if (!session.comparison) entry("split", reference.of, true);
      entry("heat map", VIEW_ERROR, false);
      ImGui::EndCombo();
    }
    ImGui::PopID();
  }

  static void drawTracing(Session& session) {
    using What = BackgroundReference::State::What;
    Accuracy& accuracy = session.accuracy;
    const BackgroundReference::State state = accuracy.tracing();
    if (!accuracy.outdated.empty()) paragraph(theme::warning, "Outdated: " + accuracy.outdated + ".");
    if (state.what == What::Failed) paragraph(theme::error, "No reference: " + state.error);
    if (state.what == What::Loading || state.what == What::Tracing || state.what == What::Waiting) {
      const std::string text = state.what == What::Loading ? std::string("reading the scene")
                               : state.samples == 0        ? fmt::format("0 of {}", state.wanted)
                                                           : fmt::format("{} of {}, {}", state.samples, state.wanted,
                                                                         secondsText(state.secondsLeft) + " left");
      ImGui::ProgressBar(static_cast<float>(state.samples) / static_cast<float>(std::max(state.wanted, 1u)), {-1, 0},
                         text.c_str());
      if (ImGui::Button("Cancel###cancel reference", {-1, 0})) accuracy.cancelReference = true;
      helpTooltip("What there is of it stays");
      return;
    }
    const bool can = hasPathTracer(), lambertian = session.edited.scene.lambertian;
    fieldLabel("compute",
               "What to trace. The path tracer is diffuse: indirect light, or with scene.lambertian all of it");
    ImGui::PushID("compute");
    if (ImGui::BeginCombo("##", accuracy.indirect || !lambertian ? "indirect" : "lit")) {
      if (ImGui::Selectable("indirect", accuracy.indirect || !lambertian)) accuracy.indirect = true;
      ImGui::BeginDisabled(!lambertian);
      if (ImGui::Selectable(lambertian ? "lit" : "lit: with scene.lambertian###lit", !accuracy.indirect && lambertian))
        accuracy.indirect = false;
      ImGui::EndDisabled();
      ImGui::EndCombo();
    }
    ImGui::PopID();
    fieldLabel("samples", "Per pixel. Twice as many leave .71 of the noise");
    ImGui::PushID("samples");
    if (ImGui::BeginCombo("##", std::to_string(accuracy.samples).c_str())) {
      for (const uint32_t samples : {16u, 64u, 256u, 1024u, 4096u})
        if (ImGui::Selectable(std::to_string(samples).c_str(), samples == accuracy.samples)) accuracy.samples = samples;
      ImGui::EndCombo();
    }
    ImGui::PopID();
    ImGui::BeginDisabled(!can);
    if (ImGui::Button("Compute a reference", {-1, 0})) accuracy.wantReference = true;
    ImGui::EndDisabled();
    helpTooltip(fmt::format(
        "A path tracer on the triangles, from this camera and at this size, on {} of the processor's threads at the "
        "lowest priority. It stops where camera, scene, lights or materials change, and pauses while this panel is "
        "folded.",
        BackgroundReference::threads()));
    if (!can) paragraph(theme::dim, "This build has no path tracer (IRAD_EMBREE).");
  }

  // ---- Milliseconds ----

  void drawTimes(const Session& session) {
    constexpr size_t kFrames = 300;
    const Timings& timings = session.context.timings;
    if (timings.recorded() != rowsOf_ && refresh_.due(session)) {
      rows_ = timingRows(stageSamples(timings.frames(), kFrames));
      rowsOf_ = timings.recorded();
    }
    const auto group = [&](const char* name, CostOf work, const char* help) {
      double sum = 0;
      bool any = false;
      for (const Timings::Row& row : rows_)
        if (workOf(row) == work && row.stage != "UI") sum += row.stats.p50, any = true;
      ImGui::TableNextRow();
      ImGui::TableNextColumn();
      const bool open = ImGui::TreeNodeEx(name, ImGuiTreeNodeFlags_SpanFullWidth);
      helpTooltip(help);
      ImGui::TableNextColumn();
      rightText(any ? milliseconds(sum) + " ms" : "\u2014");
      if (!open) return;
      for (const Timings::Row& row : rows_) {
        if (workOf(row) != work || row.stage == "UI") continue;
        ImGui::TableNextRow();
        ImGui::TableNextColumn();
        clippedText(row.stage, ImGui::GetContentRegionAvail().x);
        ImGui::TableNextColumn();
        rightText(milliseconds(row.stats.p50) + " ms");
      }
      ImGui::TreePop();
    };
    if (ImGui::BeginTable("times", 2, ImGuiTableFlags_SizingStretchProp)) {
      ImGui::TableSetupColumn("stage", 0, 1.6f);
      ImGui::TableSetupColumn("ms");
      group("build", CostOf::Build, "GPU ms of all stages of a rebuild: medians of those since the start");
      group("relight", CostOf::Relight,
            "GPU ms that a frame takes while light converges: medians of the last 300 frames in which a stage ran");
      group("frame", CostOf::Frame, "GPU ms of a picture: medians likewise");
      ImGui::EndTable();
    }
    drawFramesLeft(session);
  }

  static void drawFramesLeft(const Session& session) {
    const SolveReport& report = session.built->solve;
    std::string text = "\u2014";
    if (session.asleep()) {
      text = report.converged ? "converged" : "stopped";
    } else if (report.frames > 0) {
      text = fmt::format("at most {}", withThousands(session.pipeline->settings().solver.frames - report.frames));
      if (report.frames > 1 && report.allowed > 0) {
        const double ratio = report.standardError / report.allowed;
        const auto most = static_cast<double>(session.pipeline->settings().solver.frames);
        text = fmt::format("about {:.0f}", std::ceil(std::min(ratio * ratio * report.frames, most) - report.frames));
      }
    } else {
      std::vector<BoundSample> bounds;
      uint64_t sweeps = 0;
      for (const SolveSample& s : session.solves) bounds.push_back({sweeps += s.sweeps, s.bound});
      const double each = std::max(session.pipeline->settings().solver.sweepsPerFrame, 1u);
      if (const auto left = report.allowed > 0 ? sweepsLeft(bounds, report.allowed) : std::nullopt)
        text = fmt::format("about {:.0f}", std::ceil(*left / each));
    }
    valueRow("frames to go", text);
    helpTooltip(
        "Until the solver sleeps: from the slope of its bound over the last calls and solver.sweeps_per_frame; by "
        "brute force from its standard error");
  }

  // ---- The study ----

  void findPlace(const Session& session) {
    const LoadedStudy* study = session.accuracy.study ? &*session.accuracy.study : nullptr;
    if (!study || study->points.empty()) {
      place_.reset();
      return;
    }
    const uint64_t serial = session.accuracy.studies;
    if (placeIn_ == serial && placeOf_ == session.edited && place_) return;
    place_ = irad::placeOf(study->settings, study->measured(), session.edited);
    placeIn_ = serial;
    placeOf_ = session.edited;
  }

  void drawStudy(Session& session) {
    Accuracy& accuracy = session.accuracy;
    const float button = ImGui::CalcTextSize("Load").x + 2 * ImGui::GetStyle().FramePadding.x;
    ImGui::SetNextItemWidth(ImGui::GetContentRegionAvail().x - button - ImGui::GetStyle().ItemSpacing.x);
    const bool entered = ImGui::InputTextWithHint("##study", "folder of irad study cost", &accuracy.folder,
                                                  ImGuiInputTextFlags_EnterReturnsTrue);
    ImGui::SameLine();
    if (ImGui::Button("Load", {button, 0}) || entered) accuracy.wantStudy = true;
    helpTooltip("A folder of irad study cost, of irad study attribution, or one after the other of both");
    if (accuracy.loading()) return ImGui::TextColored(theme::dim, "reading\u2026");
    if (!accuracy.studyError.empty()) return paragraph(theme::error, accuracy.studyError);
    if (!accuracy.study) return paragraph(theme::dim, "irad study cost measures what accuracy costs; load its folder.");
    const LoadedStudy& study = *accuracy.study;
    drawOrigin(session, study);
    if (!study.points.empty()) drawFront(session, study);
  }

  /// What a study says holds for its scene and device.
  static void drawOrigin(const Session& session, const LoadedStudy& study) {
    const Scene& scene = session.pipeline->scene();
    if (!study.sceneSha256.empty() && study.sceneSha256 != scene.sha256)
      paragraph(theme::warning, fmt::format("Of another scene: {}.", study.scene));
    if (!study.device.empty() && study.device != session.context.device.info.name)
      paragraph(theme::warning, fmt::format("Its times are of another device: {}.", study.device));
    if (!study.view.empty())
      paragraph(theme::dim, fmt::format("Of {}, {} \u00D7 {} pixels.", study.view, study.size.x, study.size.y));
  }

  void drawFront(Session& session, const LoadedStudy& study) {
    const std::vector<CostKind>& kinds = costKinds();
    const CostKind& kind = kinds[cost_];
    fieldLabel("cost", "What the error is weighed against");
    ImGui::PushID("cost");
    if (ImGui::BeginCombo("##", nameOf(kind).c_str())) {
      for (size_t i = 0; i < kinds.size(); ++i) {
        if (ImGui::Selectable(nameOf(kinds[i]).c_str(), i == cost_)) cost_ = i;
        helpTooltip(kinds[i].axis);
      }
      ImGui::EndCombo();
    }
    ImGui::PopID();

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
    if (shown.points.empty()) return paragraph(theme::dim, "No point of it has this cost and an error above 0.");
    const std::vector<size_t> onFront = front(pairs);
    for (FrontPlot::Point& p : shown.points) p.onFront = std::ranges::find(onFront, p.number) != onFront.end();
    shown.costUnit = kind.unit;
    if (place_) shown.here = place_->point, shown.exactly = place_->apart.empty();
    const FrontAnswer answer =
        frontPlot({ImGui::GetContentRegionAvail().x, std::floor(12 * ImGui::GetFontSize())}, shown);
    if (answer.clicked) take(session, study.settings[*answer.clicked]);
    drawPlace(study, kind, pairs);
    if (!before_) return;
    if (ImGui::Button("Back to the settings before", {-1, 0})) {
      const Settings back = *before_;
      take(session, back);
      before_.reset();
    }
  }

  static std::string textOf(const PointSummary& p) {
    std::string out = fmt::format("point {}: {}\nrelMSE {}", p.point, p.label, shortNumber(p.relMse.mean));
    if (p.seeds > 1) out += fmt::format(" \u00B1 {} over {} seeds", shortNumber(p.relMse.half), p.seeds);
    for (const CostKind& kind : costKinds())
      if (const double value = kind.of(p); std::isfinite(value))
        out += fmt::format("\n{} {}", nameOf(kind), costText(value, kind));
    return out + "\nA click takes its settings.";
  }

  /// The edited settings, as if they had been typed; those of views, camera and seed stay.
  void take(Session& session, const Settings& from) {
    before_ = session.edited;
    for (const Setting& setting : settingTable())
      if (countsInStudies(setting)) setting.set(session.edited, setting.get(from));
  }

  void drawPlace(const LoadedStudy& study, const CostKind& kind, const std::vector<CostAndError>& pairs) const {
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
    paragraph(theme::text, where + ".");
    if (!(here.cost > 0) || !(here.error > 0)) return;
    const Slope slope = slopeAt(pairs, at);
    const auto point = [&](size_t i) { return fmt::format("point {}, {}", i, study.points[i].label); };
    if (slope.better)
      paragraph(theme::warning,
                fmt::format("Not on the front: relMSE {} for {} ({}).", shortNumber(pairs[*slope.better].error),
                            costText(pairs[*slope.better].cost, kind), point(*slope.better)));
    if (!slope.next) {
      paragraph(theme::dim,
                slope.better ? "No dearer point has less error still." : "No point of the study has less error.");
      return;
    }
    const CostAndError& next = pairs[*slope.next];
    const double more = next.cost - here.cost;
    std::string buys;
    if (more > 1)
      buys = fmt::format("+1 {} buys {} of the error; ", kind.unit,
                         sharePercent(1 - slope.errorFor(here, 1) / here.error));
    const PointSummary &a = study.points[at], &b = study.points[*slope.next];
    const bool unsure = a.seeds > 1 && b.seeds > 1 && here.error - a.relMse.half < next.error + b.relMse.half;
    paragraph(theme::text, fmt::format("{}{} {} more: relMSE {} {} {} ({}){}.", buys, costNumber(more, kind), kind.unit,
                                       shortNumber(here.error), arrowGlyph(), shortNumber(next.error),
                                       point(*slope.next), unsure ? "; their intervals overlap" : ""));
  }

  /// "first picture": as points.csv has it, for the eye.
  static std::string nameOf(const CostKind& kind) {
    std::string name = kind.name;
    std::ranges::replace(name, '_', ' ');
    return name;
  }
  static std::string costNumber(double value, const CostKind& kind) {
    return kind.time ? milliseconds(value) : fmt::format("{:.0f}", value);
  }
  static std::string costText(double value, const CostKind& kind) {
    return fmt::format("{} {}", costNumber(value, kind), kind.unit);
  }
};

}  // namespace

std::unique_ptr<Panel> makeAccuracyPanel() {
  return std::make_unique<AccuracyPanel>();
}

}  // namespace irad
