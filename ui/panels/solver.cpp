// The solver: how far, how exact, awake or asleep and why; residual and bound over the sweeps; the energy's balance.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cfloat>
#include <cmath>
#include <span>

#include "gi/convergence.h"
#include "gi/lighting.h"
#include "gi/pipeline.h"
#include "ui/imgui.h"
#include "ui/panel.h"
#include "ui/plot.h"
#include "ui/setting_rows.h"
#include "ui/theme.h"
#include "ui/widgets.h"
#include "ui/words.h"

namespace irad {
namespace {

class SolverPanel : public Panel {
 public:
  const char* title() const override { return "Solver"; }
  const char* help() const override { return "How far the indirect light has been solved, and whether that goes on"; }
  Region region() const override { return Region::Right; }

  void draw(Session& session) override {
    if (!session.built) {
      ImGui::TextColored(theme::dim, "nothing solved yet");
      return;
    }
    sideLine(session);
    drawState(session);
    drawButtons(session);
    const SolveReport& report = session.built->solve;
    collect(session);
    if (report.frames > 0) {
      drawFrames(session);
      drawWatch(*session.built);
      settingRow(session.edited, session.defaults, "solver.frames");
      return;
    }
    valueRow("sweeps", sweepsText(session));
    helpTooltip(
        "Rounds in which every facet gathers once, since the solver last woke; how many are left is extrapolated from "
        "the bound's slope over the last frames");
    valueRow("residual", withDigits(report.residual) + " W/m\u00B2");
    helpTooltip("Largest change of the radiosity B in the last sweep");
    valueRow("error bound", withDigits(report.bound) + " W/m\u00B2");
    helpTooltip(
        "How far B can be from the exact solution at most: (\u03BA/\u03C9 \u2212 1) times the residual, \u03BA the "
        "error factor below, \u03C9 solver.omega");
    valueRow("sleeps below", withDigits(session.built->solve.allowed) + " W/m\u00B2");
    helpTooltip(
        "The error bound at which the indirect light H is known to solver.tolerance of its mean: the solver sleeps "
        "then");
    valueRow("mean, largest H", withDigits(report.meanH) + ", " + withDigits(report.largestH) + " W/m\u00B2");
    helpTooltip(
        "Indirect irradiance H over all facets: its mean by their areas, and its largest; of the brightest colour "
        "channel");
    valueRow("largest row gain", withDigits(report.largestGain));
    helpTooltip("The largest share of its light that a facet's row passes on: below 1 the solver converges");
    valueRow("error factor \u03BA", withDigits(report.kappa));
    helpTooltip(
        "\u03BA: proven from the gains of all rows together, an error of B is at most so many times the residual");
    drawReflections(session);
    drawCurves();
    drawEnergy(*session.built);
    drawWatch(*session.built);
    settingRow(session.edited, session.defaults, "solver.sweeps_per_frame");
  }

 private:
  /// Brute force.
  void drawFrames(const Session& session) const {
    const SolveReport& report = session.built->solve;
    valueRow("frames", fmt::format("{} of {}", withThousands(report.frames),
                                   withThousands(session.pipeline->settings().solver.frames)));
    helpTooltip("Frames of rays that the mean H is made of; a change of the scene or its light begins anew");
    valueRow("standard error", withDigits(report.standardError) + " W/m\u00B2");
    helpTooltip(
        "Of H, from the spread of the frames: the mean over the facets' areas, of the brightest colour channel. The "
        "view standard-error shows each facet's");
    valueRow("ends below", withDigits(report.allowed) + " W/m\u00B2");
    helpTooltip("The standard error at which it ends: solver.tolerance times the mean H");
    valueRow("mean, largest H", withDigits(report.meanH) + ", " + withDigits(report.largestH) + " W/m\u00B2");
    helpTooltip(
        "Indirect irradiance H over all facets: its mean by their areas, and its largest; of the brightest colour "
        "channel");
    valueRow("largest row gain", withDigits(report.largestGain));
    helpTooltip("The largest share of its light that a facet's rays of the last frame pass on");
    const PlotLine lines[] = {{"standard error", ImGui::GetColorU32(theme::accent), bound_}};
    drawPlot(lines, "frame", "the standard error is drawn from the second frame on", "dashed: target");
  }

  std::vector<BoundSample> bounds_;
  std::vector<float> x_, residual_, bound_;  ///< of the curves
  double target_ = 0;

  static const char* asleepBecause(const SolveReport& report) {
    if (report.frames == 0) return "Asleep: nothing has changed, and the error bound is below target.";
    return report.converged ? "Asleep: nothing has changed, and the standard error is below target."
                            : "Asleep: nothing has changed, and there are as many frames as solver.frames allows.";
  }

  static void drawState(const Session& session) {
    const SolveReport& report = session.built->solve;
    const auto [color, state] =
        session.built->faulty() ? std::pair{theme::error, "Stopped by the numerical watch, see below."}
        : report.diverging
            ? std::pair{theme::error, "Stopped: the light would grow without bound (lambda, albedo). The last is kept."}
        : session.asleep() ? std::pair{theme::good, asleepBecause(report)}
        : session.halted   ? std::pair{theme::warning, "Halted: the rebuild failed or was cancelled."}
        : session.paused
            ? std::pair{theme::warning, report.frames > 0 ? "Paused before the last frame."
                                                          : "Paused before the error bound has come below target."}
        : report.damped     ? std::pair{theme::warning, "Awake, damped: the residual was growing."}
        : report.frames > 0 ? std::pair{theme::accent, "Awake: frames are added to the mean."}
                            : std::pair{theme::accent, "Awake: the error bound is still above target."};
    ImGui::PushTextWrapPos(0);
    ImGui::TextColored(color, "%s", state);
    ImGui::PopTextWrapPos();
  }

  static void drawButtons(Session& session) {
    const float gap = ImGui::GetStyle().ItemSpacing.x;
    const ImVec2 third{std::floor((ImGui::GetContentRegionAvail().x - 2 * gap) / 3), 0};
    if (ImGui::Button(session.paused ? "Resume###pause" : "Pause###pause", third)) session.paused = !session.paused;
    helpTooltip(session.paused ? "Lets the solver go on (Space)" : "The light stays as it is until you resume (Space)");
    ImGui::SameLine();
    if (ImGui::Button("Step", third)) session.paused = session.step = true;
    helpTooltip("One sweep or frame, then pause");
    ImGui::SameLine();
    if (ImGui::Button("Darken###H = 0", third)) session.darken = true;
    helpTooltip("Forgets all indirect light (H = 0): the solver starts again from the dark");
  }

  /// What the last picture has written back, where it has.
  static void drawReflections(const Session& session) {
    const auto& report = session.pipeline->lighting().writeback.report;
    if (!report || report->pending) return;
    valueRow("written back",
             fmt::format("{} of {}", withThousands(report->written()), counted(report->visible(), "facet")));
    helpTooltip("Of the facets that pixels see those to which any has written the reflection that it shows");
    valueRow("writers 0, 1, more",
             fmt::format("{}, {}, {}", withThousands(report->writers[0]), withThousands(report->writers[1]),
                         withThousands(report->written() - report->writers[1])));
    helpTooltip(
        "Visible facets by how many pixels have written to them; with writeback.mode=compute the mean of all is one");
    std::array<float, WRITEBACK_BINS> bars{};
    std::ranges::copy(report->writers, bars.begin());
    ImGui::PlotHistogram("##writers", bars.data(), static_cast<int>(bars.size()), 0, nullptr, 0, FLT_MAX,
                         {ImGui::GetContentRegionAvail().x, std::floor(3 * ImGui::GetFontSize())});
    helpTooltip("Visible facets with 0, 1, ... 7 writers, and with 8 or more");
    valueRow("written W, change", withDigits(report->largest) + ", " + withDigits(report->change) + " W/m\u00B2");
    helpTooltip("The largest that is written back, and by how much it differs from what the light was solved with");
  }

  /// The solver's calls as curves over all sweeps since it woke.
  void collect(const Session& session) {
    uint64_t sweeps = session.sweepsSinceWake;
    for (const SolveSample& s : session.solves) sweeps -= s.sweeps;  // of calls that are no longer kept
    bounds_.clear(), x_.clear(), residual_.clear(), bound_.clear();
    for (const SolveSample& s : session.solves) {
      sweeps += s.sweeps;
      if (session.built->solve.frames > 0 && s.bound == 0) continue;  // a single frame has no standard error
      bounds_.push_back({sweeps, s.bound});
      x_.push_back(static_cast<float>(sweeps));
      residual_.push_back(s.residual);
      bound_.push_back(s.bound);
    }
    target_ = session.built->solve.allowed;
  }

  std::string sweepsText(const Session& session) const {
    const std::string done = withThousands(session.sweepsSinceWake);
    if (session.asleep()) return session.built->solve.converged ? done + ", target reached" : done;
    if (session.sweepsSinceWake == 0) return "none yet";
    const std::optional<double> left = target_ > 0 ? sweepsLeft(bounds_, target_) : std::nullopt;
    return left ? fmt::format("{}, about {:.0f} left", done, std::ceil(*left)) : done;
  }

  void drawCurves() const {
    const PlotLine lines[] = {{"error bound", ImGui::GetColorU32(theme::accent), bound_},
                              {"residual", ImGui::GetColorU32(theme::good), residual_}};
    drawPlot(lines, "sweep", "residual and bound are drawn from the second frame on", "dashed: target");
  }

  /// Over `step`s, in the singular; `few`: in place of curves of one call, `mark`: what the dashed line is.
  void drawPlot(std::span<const PlotLine> lines, const char* step, const char* few, const char* mark) const {
    if (x_.size() < 2) {
      ImGui::PushTextWrapPos(0);
      ImGui::TextColored(theme::dim, "%s", few);
      ImGui::PopTextWrapPos();
      return;
    }
    PlotAxes axes;
    axes.logarithmic = true;
    axes.x = x_;
    axes.xText = [step](float v) { return counted(static_cast<uint64_t>(v), step); };
    axes.yText = [](float v) { return shortNumber(v); };
    if (target_ > 0) axes.mark = static_cast<float>(target_);
    plot({ImGui::GetContentRegionAvail().x, std::floor(8 * ImGui::GetFontSize())}, lines, axes);
    for (const PlotLine& line : lines) {
      ImGui::PushStyleColor(ImGuiCol_Text, line.color);
      ImGui::TextUnformatted(line.name.c_str());
      ImGui::PopStyleColor();
      ImGui::SameLine();
    }
    ImGui::PushStyleColor(ImGuiCol_Text, theme::dim);
    clippedText(mark, ImGui::GetContentRegionAvail().x);
    ImGui::PopStyleColor();
  }

  /// All channels together, W; the scene's units are taken for metres.
  static void drawEnergy(const Built& built) {
    if (!built.solve.energy) {
      valueRow("energy", "\u2026");
      helpTooltip("Known once the solver has converged with solver.lambda 1; not where panes tint");
      return;
    }
    const EnergyBalance& energy = *built.solve.energy;
    const double area = built.edge * built.edge;
    const auto watts = [&](const glm::dvec3& v) { return fmt::format("{:.4g} W", area * (v.x + v.y + v.z)); };
    valueRow("energy in", watts(energy.entering));
    helpTooltip(
        "Power that enters the scene, W: emitted, and direct light that arrives. The sum over facets of A (M + D), A "
        "their areas");
    valueRow("absorbed", watts(energy.absorbed));
    helpTooltip("Power that surfaces take up, W: the sum over facets of A (1 \u2212 \u03C1)(D + H)");
    valueRow("escaped", watts(energy.escaped));
    helpTooltip("Power that leaves the scene, W: the sum over facets of A B (1 \u2212 row sum)");
    valueRow("imbalance", percentText(energy.imbalance(), 2, /*plus=*/true));
    helpTooltip(
        "What enters less what is absorbed and what escapes, as a share of what enters: 0 but for what sweeps have "
        "left\n" +
        describe(energy, built.edge));
  }

  /// The numerical watch.
  static void drawWatch(const Built& built) {
    const SolveReport& report = built.solve;
    valueRow("NaN, inf, < 0", fmt::format("{}, {}, {}", report.nan, report.nonFinite - report.nan, report.negative));
    helpTooltip("Components of B that are no number, infinite or negative: all should be 0");
    ImGui::PushTextWrapPos(0);
    for (const Finding& finding : built.findings)
      ImGui::TextColored(finding.severity == Finding::Severity::Error ? theme::error : theme::warning, "%s",
                         finding.text.c_str());
    ImGui::PopTextWrapPos();
  }
};

}  // namespace

std::unique_ptr<Panel> makeSolverPanel() {
  return std::make_unique<SolverPanel>();
}

}  // namespace irad
