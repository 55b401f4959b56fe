// The solver: how far, how exact, awake or asleep; residual and bound over the sweeps.
#include <fmt/format.h>
#include <imgui.h>

#include <algorithm>
#include <cmath>

#include "ui/panel.h"
#include "ui/theme.h"
#include "ui/widgets.h"

namespace irad {
namespace {

class SolverPanel : public Panel {
 public:
  const char* title() const override { return "Solver"; }
  Region region() const override { return Region::Right; }

  void draw(Session& session) override {
    if (!session.built) {
      ImGui::TextColored(theme::dim, "nothing solved yet");
      return;
    }
    drawState(session);
    const SolveReport& report = session.built->solve;
    valueRow("sweeps", withThousands(session.sweepsSinceWake));
    valueRow("residual", shortNumber(report.residual) + " W/m\u00B2");
    helpTooltip("Largest change of B in the last sweep");
    valueRow("error bound", shortNumber(report.bound) + " W/m\u00B2");
    helpTooltip("On B: \u03C1/(1\u2212\u03C1) times the residual, \u03C1 the largest row gain");
    valueRow("target", shortNumber(session.built->tolerance * report.largestH) + " W/m\u00B2");
    helpTooltip("solver.tolerance times the largest H");
    valueRow("row gain \u03C1", shortNumber(report.largestGain));
    drawWatch(*session.built);
    settingRow(session.edited, session.defaults, "solver.sweeps_per_frame");
    drawCurves(session);
  }

 private:
  static void drawState(Session& session) {
    const bool asleep = session.asleep();
    const auto [color, state] = session.paused            ? std::pair{theme::warning, "paused"}
                                : session.built->faulty() ? std::pair{theme::error, "stopped: numerical watch"}
                                : asleep                  ? std::pair{theme::good, "asleep: bound below target"}
                                                          : std::pair{theme::accent, "awake"};
    ImGui::AlignTextToFramePadding();
    ImGui::TextColored(color, "%s", state);
    const char* label = session.paused ? "Resume" : "Pause";
    const float width = ImGui::CalcTextSize("Resume").x + 2 * ImGui::GetStyle().FramePadding.x;
    ImGui::SameLine(ImGui::GetCursorPosX() + ImGui::GetContentRegionAvail().x - width);
    if (ImGui::Button(label, {width, 0})) session.paused = !session.paused;
    helpTooltip("Space");
  }

  /// The numerical watch.
  static void drawWatch(const Built& built) {
    const SolveReport& report = built.solve;
    valueRow("NaN, Inf, < 0", fmt::format("{}, {}, {}", report.nan, report.nonFinite - report.nan, report.negative));
    helpTooltip("Components of B that are no number, infinite or negative: all should be 0");
    valueRow("energy", report.energy ? fmt::format("{:+.2f} %", 100 * report.energy->imbalance()) : "\u2026");
    helpTooltip(report.energy ? describe(*report.energy, built.edge)
                              : "Light absorbed and escaping less light entering, as a share of it: known once the "
                                "solver has converged with solver.lambda 1");
    ImGui::PushTextWrapPos(0);
    for (const Finding& finding : built.findings)
      ImGui::TextColored(finding.severity == Finding::Severity::Error ? theme::error : theme::warning, "%s",
                         finding.text.c_str());
    ImGui::PopTextWrapPos();
  }

  /// Residual and bound of each call of the solver since it woke, logarithmic.
  static void drawCurves(const Session& session) {
    const ImVec2 low = ImGui::GetCursorScreenPos();
    const ImVec2 size{ImGui::GetContentRegionAvail().x, ImGui::GetFontSize() * 4.5f};
    ImGui::Dummy(size);
    const ImVec2 high{low.x + size.x, low.y + size.y};
    ImDrawList& list = *ImGui::GetWindowDrawList();
    list.AddRectFilled(low, high, ImGui::GetColorU32(ImGuiCol_FrameBg), ImGui::GetStyle().FrameRounding);
    float smallest = 1e30f, largest = 0;
    for (const SolveSample& s : session.solves)
      for (const float v : {s.residual, s.bound})
        if (v > 0 && std::isfinite(v)) smallest = std::min(smallest, v), largest = std::max(largest, v);
    if (session.solves.size() < 2 || largest <= 0) {
      list.AddText({low.x + 6, low.y + 4}, ImGui::GetColorU32(theme::dim), "residual and bound: from 2 steps on");
      return;
    }
    const float top = std::log10(largest), span = std::max(top - std::log10(smallest), 1.0f);
    const auto curve = [&](float SolveSample::*member, const ImVec4& color) {
      std::vector<ImVec2> points;
      for (size_t i = 0; i < session.solves.size(); ++i) {
        const float v = std::max(session.solves[i].*member, smallest);
        const float x = static_cast<float>(i) / static_cast<float>(session.solves.size() - 1);
        const float y = (top - std::log10(v)) / span;
        points.push_back({low.x + 4 + x * (size.x - 8), low.y + 4 + std::clamp(y, 0.0f, 1.0f) * (size.y - 8)});
      }
      list.AddPolyline(points.data(), static_cast<int>(points.size()), ImGui::GetColorU32(color), 0, 1.5f);
    };
    curve(&SolveSample::bound, theme::accent);
    curve(&SolveSample::residual, theme::good);
    if (ImGui::IsItemHovered())
      helpTooltip(fmt::format("Error bound (amber) and residual (green), W/m\u00B2, logarithmic: {} to {}",
                              shortNumber(smallest), shortNumber(largest)));
  }
};

}  // namespace

std::unique_ptr<Panel> makeSolverPanel() {
  return std::make_unique<SolverPanel>();
}

}  // namespace irad
