// The effect plan: what the scene calls for, what not, why, and what that saves; every effect may be forced on or off.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>

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
    // In the middle of a rebuild what the pipeline holds comes and goes.
    if (session.built && !session.work && refresh_.due(session)) plan_ = session.pipeline->plan(session.viewDirty);
    if (!session.built || !plan_) {
      ImGui::TextColored(theme::dim, "nothing built yet");
      return;
    }
    sideLine(session);
    // Low rows: the column has room for them beside the settings in a window of 720 lines.
    ImGui::PushStyleVar(ImGuiStyleVar_ItemSpacing, {ImGui::GetStyle().ItemSpacing.x, 0});
    ImGui::PushStyleVar(ImGuiStyleVar_FramePadding,
                        {ImGui::GetStyle().FramePadding.x, std::floor(0.1f * ImGui::GetFontSize())});
    const auto foldsAway = [&](const EffectRow& row) {
      return row.state == EffectState::off && !isForced(session.edited, row);
    };
    for (const EffectRow& row : plan_->rows)
      if (!foldsAway(row)) drawRow(session.edited, row);
    if (drawOff(session.edited, session.preferences.folded))
      for (const EffectRow& row : plan_->rows)
        if (foldsAway(row)) drawRow(session.edited, row);
    ImGui::PopStyleVar(2);
    ImGui::Spacing();
  }

 private:
  std::optional<EffectPlan> plan_;  ///< none before the first has been built
  Refresh refresh_;

  static bool isForced(const Settings& settings, const EffectRow& row) {
    return forcedMode(settings, row.effect) != EffectMode::automatic;
  }

  /// The line that those fold under which are left out of themselves, beside how many are forced off. True: they are
  /// listed.
  bool drawOff(const Settings& settings, std::set<std::string>& folded) const {
    struct {
      uint64_t count = 0, bytes = 0;
    } left, forced;
    for (const EffectRow& row : plan_->rows)
      if (row.state == EffectState::off) {
        auto& of = isForced(settings, row) ? forced : left;
        ++of.count;
        of.bytes += row.bytesNotAllocated;
      }
    if (left.count + forced.count == 0) return false;
    const std::string text = forced.count == 0
                                 ? fmt::format("{} off, {} not allocated", left.count, mebibytes(left.bytes))
                                 : fmt::format("{} off, {}; {} forced off, {}", left.count, mebibytes(left.bytes),
                                               forced.count, mebibytes(forced.bytes));
    ImGui::SetNextItemOpen(!folded.contains(kEffectsOff));
    const bool open = ImGui::TreeNodeEx((text + "###off").c_str(), ImGuiTreeNodeFlags_NoTreePushOnOpen |
                                                                       ImGuiTreeNodeFlags_SpanAvailWidth |
                                                                       (left.count == 0 ? ImGuiTreeNodeFlags_Leaf : 0));
    helpTooltip([&] {
      return text +
             "\nOff: what scene and settings do not call for, with the reasons. Forced off: by the lists behind the "
             "arrows (they stay in the list above). The device memory is what each would take, by the formulas (a csr "
             "matrix: at most), and is not allocated.";
    });
    keepFolded(folded, kEffectsOff, open);
    return open;
  }

  /// One line: name, state and reason, and where the effect can be forced, the list of modes behind an arrow.
  static void drawRow(Settings& settings, const EffectRow& row) {
    const EffectInfo& info = row.info();
    const bool forced = isForced(settings, row);
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
