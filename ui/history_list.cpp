#include "ui/history_list.h"

#include <optional>

#include "ui/imgui.h"
#include "ui/theme.h"
#include "ui/widgets.h"

namespace irad {

void historyList(Session& session, float width) {
  const std::vector<History::Step>& steps = session.history.steps();
  const int count = static_cast<int>(steps.size());
  std::optional<size_t> wanted;
  ImGuiListClipper clipper;
  clipper.Begin(count, ImGui::GetTextLineHeightWithSpacing());
  while (clipper.Step())
    for (int row = clipper.DisplayStart; row < clipper.DisplayEnd; ++row) {
      const auto step = static_cast<size_t>(count - 1 - row);
      const bool present = step == session.history.at();
      ImGui::PushID(static_cast<int>(step));
      const float start = ImGui::GetCursorPosX();
      if (ImGui::Selectable("##", present, ImGuiSelectableFlags_DontClosePopups)) wanted = step;
      helpTooltip(present ? "The state that is shown" : "Click: everything is as it was after this edit");
      ImGui::SameLine(start);
      ImGui::PushStyleColor(ImGuiCol_Text, step > session.history.at() ? theme::dim : theme::text);
      clippedText(steps[step].name, width);
      ImGui::PopStyleColor();
      ImGui::PopID();
    }
  if (wanted) session.goToStep(*wanted);
}

}  // namespace irad
