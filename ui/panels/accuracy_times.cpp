// The panel Accuracy: milliseconds, and frames to come.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "gi/convergence.h"
#include "ui/panels/accuracy_parts.h"
#include "ui/setting_rows.h"

namespace irad {
namespace {

/// The kinds of work that a study weighs, as they run in the window.
enum class CostOf { Build, Relight, Frame };
CostOf workOf(const Timings::Row& row) {
  if (row.kind == WorkKind::Setup) return CostOf::Build;
  return row.stage.starts_with("GI ") || row.stage == "RE Shadow" ? CostOf::Relight : CostOf::Frame;
}

void drawFramesLeft(const Session& session) {
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
      "Frames until the solver sleeps: from the slope of its bound over the last calls and solver.sweeps_per_frame; by "
      "brute force from its standard error");
}

}  // namespace

void AccuracyTimes::draw(const Session& session) {
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
    ImGui::TableSetupColumn("ms", 0, 1);
    group("build", CostOf::Build,
          "Milliseconds of the GPU for all stages of a rebuild: medians of the rebuilds since the start; click: each "
          "stage");
    group("relight", CostOf::Relight,
          "Milliseconds of the GPU that a frame takes while light converges: medians of the last 300 frames in which a "
          "stage "
          "ran; click: each stage");
    group("frame", CostOf::Frame, "Milliseconds of the GPU for a picture: medians likewise; click: each stage");
    ImGui::EndTable();
  }
  drawFramesLeft(session);
}

}  // namespace irad
