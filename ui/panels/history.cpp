// What was edited, step by step: a click goes to a step.
#include <algorithm>

#include "ui/history_list.h"
#include "ui/imgui.h"
#include "ui/panel.h"
#include "ui/theme.h"
#include "ui/widgets.h"

namespace irad {
namespace {

class HistoryPanel : public Panel {
 public:
  const char* title() const override { return "History"; }
  const char* help() const override {
    return "Every edit since the scene was opened; a click goes back or forward to one";
  }
  Region region() const override { return Region::Left; }

  void draw(Session& session) override {
    const size_t count = session.history.steps().size();
    if (count == 0) return ImGui::TextColored(theme::dim, "no scene");
    const auto button = [&](const char* label, Action action, bool enabled, const char* help) {
      ImGui::BeginDisabled(!enabled);
      if (ImGui::Button(label)) session.act(action);
      helpTooltip(help);
      ImGui::EndDisabled();
    };
    button("Undo", Action::Undo, session.history.canUndo(), "Takes the last edit back (Ctrl + Z)");
    ImGui::SameLine();
    button("Redo", Action::Redo, session.history.canRedo(),
           "Makes the edit again that was taken back (Ctrl + Shift + Z, Ctrl + Y)");
    constexpr float most = 8;
    const float rows = std::min(static_cast<float>(session.history.steps().size()), most);
    ImGui::BeginChild("##list", {0, rows * ImGui::GetTextLineHeightWithSpacing()});
    // The step that is shown stays in view when it changes.
    const size_t at = session.history.at();
    if (at != shown_ || count != count_) {
      const float line = ImGui::GetTextLineHeightWithSpacing();
      ImGui::SetScrollY(std::max(0.0f, (static_cast<float>(count - 1 - std::min(at, count - 1)) - most / 2) * line));
      shown_ = at;
      count_ = count;
    }
    historyList(session, ImGui::GetContentRegionAvail().x);
    ImGui::EndChild();
  }

 private:
  size_t shown_ = 0, count_ = 0;
};

}  // namespace

std::unique_ptr<Panel> makeHistoryPanel() {
  return std::make_unique<HistoryPanel>();
}

}  // namespace irad
