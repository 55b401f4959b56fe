#include "ui/recording_comparison.h"

#include <fmt/format.h>

#include "ui/imgui.h"
#include "ui/theme.h"
#include "ui/widgets.h"

namespace irad {
namespace {

void drawChange(const StageChange& c) {
  const bool judged = c.verdict != Verdict::TooFew;
  const ImVec4& color = c.verdict == Verdict::Slower   ? theme::error
                        : c.verdict == Verdict::Faster ? theme::good
                                                       : theme::dim;
  const auto word = [](const std::string& text) {
    ImGui::TableNextColumn();
    clippedText(text, ImGui::GetContentRegionAvail().x);
  };
  ImGui::TableNextRow();
  word(c.stage);
  word(toString(c.kind));
  for (const std::string& number :
       {milliseconds(c.before), milliseconds(c.after), judged ? fmt::format("{:.3f}", c.ratio) : std::string("-")}) {
    ImGui::TableNextColumn();
    rightText(number);
  }
  word(judged ? fmt::format("{:.3f} to {:.3f}", c.low, c.high) : "-");
  helpTooltip(
      fmt::format("Where the ratio of the medians lies, by a block bootstrap of {} and {} samples; 5 % for all "
                  "rows together",
                  c.samples[0], c.samples[1]));
  ImGui::PushStyleColor(ImGuiCol_Text, color);
  word(toString(c.verdict));
  ImGui::PopStyleColor();
}

}  // namespace

void RecordingComparison::draw(Recorder& recorder) {
  constexpr std::array hints{"first recording", "second recording"};
  const float button = ImGui::CalcTextSize("Compare").x + 2 * ImGui::GetStyle().FramePadding.x;
  const float gap = ImGui::GetStyle().ItemSpacing.x, arrow = ImGui::GetFrameHeight();
  const float width = (ImGui::GetContentRegionAvail().x - button - 2 * arrow - 4 * gap) / 2;
  for (size_t i = 0; i < folders_.size(); ++i) {
    ImGui::PushID(static_cast<int>(i));
    ImGui::SetNextItemWidth(width);
    ImGui::InputTextWithHint("##folder", clipped(hints[i], width - 2 * ImGui::GetStyle().FramePadding.x).c_str(),
                             folders_[i].data(), folders_[i].size());
    helpTooltip("Folder of a recording, as Record or irad bench --record makes it");
    ImGui::SameLine();
    const bool known = ImGui::BeginCombo("##known", "", ImGuiComboFlags_NoPreview | ImGuiComboFlags_PopupAlignLeft);
    if (!known) helpTooltip("Recordings that this window has made");
    if (known) {
      if (recorder.recordings.empty()) ImGui::TextColored(theme::dim, "none has been made yet");
      for (const std::filesystem::path& path : recorder.recordings)
        if (ImGui::Selectable(path.string().c_str()))
          fmt::format_to_n(folders_[i].data(), folders_[i].size() - 1, "{}\0", path.string());
      ImGui::EndCombo();
    }
    ImGui::SameLine();
    ImGui::PopID();
  }
  if (ImGui::Button("Compare", {button, 0})) recorder.compare = {folders_[0].data(), folders_[1].data()};
  helpTooltip(
      "The second recording's times over the first's, stage by stage, and whether they differ by more than noise");
  drawRecordingChanges(recorder);
}

void drawRecordingChanges(const Recorder& recorder) {
  if (!recorder.problem.empty()) {
    ImGui::PushTextWrapPos(0);
    ImGui::TextColored(theme::error, "%s", recorder.problem.c_str());
    ImGui::PopTextWrapPos();
    return;
  }
  if (recorder.changes.empty()) {
    ImGui::TextColored(theme::dim, "The second recording's times over the first's, stage by stage");
    return;
  }
  if (!beginNumberTable("changes", {{"stage", "What both recordings have times of", true},
                                    {"kind", "What the stage was run for", true},
                                    {"first ms", "Median of the first recording's samples, ms"},
                                    {"second", "Median of the second recording's samples, ms"},
                                    {"ratio", "The second's median over the first's"},
                                    {"interval", "Where the ratio lies, 5 % of error for all rows together", true},
                                    {"verdict", "Whether the interval holds 1, which is within noise", true}}))
    return;
  for (const StageChange& c : recorder.changes) drawChange(c);
  ImGui::EndTable();
}

}  // namespace irad
