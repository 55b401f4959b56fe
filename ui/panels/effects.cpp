// The effect plan: what the scene calls for, what not, why, and what that saves; every effect may be forced on or off.
#include <fmt/format.h>

#include "gi/plan.h"
#include "ui/imgui.h"
#include "ui/panel.h"
#include "ui/setting_rows.h"
#include "ui/theme.h"
#include "ui/widgets.h"

namespace irad {
namespace {

class EffectsPanel : public Panel {
 public:
  const char* title() const override { return "Effects"; }
  const char* help() const override {
    return "The parts of the method: which of them run in this scene, which are left out and why, and what that saves";
  }
  Region region() const override { return Region::Left; }

  void draw(Session& session) override {
    if (!session.built) {
      ImGui::TextColored(theme::dim, "nothing built yet");
      return;
    }
    sideLine(session);
    // In the middle of a rebuild what the pipeline holds comes and goes.
    if (!session.work && refresh_.due(session)) plan_ = session.pipeline->plan(session.viewDirty);
    valueRow("not allocated", mebibytes(plan_.bytesNotAllocated()));
    helpTooltip("Device memory that the effects that are off would take, by the formulas, MiB (a csr matrix: at most)");
    ImGui::PushStyleVar(ImGuiStyleVar_ItemSpacing, {ImGui::GetStyle().ItemSpacing.x, 0});
    for (const EffectRow& row : plan_.rows) drawRow(session.edited, row);
    ImGui::PopStyleVar();
  }

 private:
  EffectPlan plan_;
  Refresh refresh_;

  /// One line: name, state and reason, and where the effect can be forced, the list of modes behind an arrow.
  static void drawRow(Settings& settings, const EffectRow& row) {
    const EffectInfo& info = row.info();
    const bool forced = forcedMode(settings, row.effect) != EffectMode::automatic;
    const float start = ImGui::GetCursorPosX(), width = ImGui::GetContentRegionAvail().x;
    const float arrow = ImGui::GetFrameHeight(), gap = ImGui::GetStyle().ItemInnerSpacing.x;
    const float words = start + width * kLabelShare, end = start + width - arrow;
    ImGui::PushID(info.name);
    ImGui::BeginGroup();
    ImGui::AlignTextToFramePadding();
    const ImVec4& nameColor = forced ? theme::accent : theme::text;
    ImGui::TextColored(nameColor, "%s", clipped(info.label, words - start - gap).c_str());
    ImGui::SameLine(words);
    ImGui::TextColored(row.state == EffectState::on ? theme::good : theme::dim, "%s", row.stateName());
    ImGui::SameLine(0, gap);
    ImGui::TextColored(theme::dim, "%s", clipped(row.reason, end - gap - ImGui::GetCursorPosX()).c_str());
    ImGui::EndGroup();
    helpTooltip([&] {
      return fmt::format(
          "{}: {}\n{}\n{}{}", info.label, row.stateName(), row.reason,
          row.epsilon > 0 ? fmt::format("Within {:.2g} of {} of what it gives forced on.", row.epsilon, row.of)
                          : "Exact: forced on it gives the same bits.",
          row.bytesNotAllocated > 0 ? fmt::format("\n{} not allocated", mebibytes(row.bytesNotAllocated)) : "");
    });
    if (*info.setting != 0) {
      ImGui::SameLine(end);
      settingArrow(settings, info.setting);
      helpTooltip([&] { return fmt::format("{}: as the scene calls for (auto), or always, or never", info.setting); });
    }
    ImGui::PopID();
  }
};

}  // namespace

std::unique_ptr<Panel> makeEffectsPanel() {
  return std::make_unique<EffectsPanel>();
}

}  // namespace irad
