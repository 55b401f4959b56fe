// What the viewport shows: the view, its unit and range, and how light becomes a picture.
#include <fmt/format.h>
#include <imgui.h>

#include "ui/panel.h"
#include "ui/theme.h"
#include "ui/widgets.h"

namespace irad {
namespace {

class ViewPanel : public Panel {
 public:
  const char* title() const override { return "View"; }
  Region region() const override { return Region::Right; }

  void draw(Session& session) override {
    const ViewInfo* shown = nullptr;
    for (const ViewInfo& info : views())
      if (info.view == session.view) shown = &info;
    drawCombo(session, shown);
    if (shown && shown->scalar)
      valueRow("range", fmt::format("{:.4g} to {:.4g} {}", shown->rangeMin, shown->rangeMax, prettyUnit(shown->unit)));
    else
      valueRow("unit", shown && *shown->unit ? prettyUnit(shown->unit) : "none");
    settingRow(session.edited, session.defaults, "camera.exposure");
    settingRow(session.edited, session.defaults, "camera.tone_curve");
    const glm::dvec3 p = session.camera.camera().position;
    valueRow("position", fmt::format("{:.2f}, {:.2f}, {:.2f}", p.x, p.y, p.z));
    valueRow("speed", fmt::format("{:.3g} units/s", session.camera.unitsPerSecond()));
    valueRow("picture", fmt::format("{} \u00D7 {}", session.targets.size.x, session.targets.size.y));
    if (ImGui::Button("Save (F12)", {-1, 0})) session.capture = true;
    helpTooltip(
        "This view at this size as PNG (as shown) and EXR (linear, before exposure and tone curve), and the manifest "
        "that "
        "`irad render --config` draws it from again. Shift + F12: all views.");
  }

 private:
  static void drawCombo(Session& session, const ViewInfo* shown) {
    ImGui::SetNextItemWidth(-1);
    if (!ImGui::BeginCombo("##view", shown ? shown->label : "?", ImGuiComboFlags_HeightLarge)) return;
    int number = 0;
    for (const ViewInfo& info : views()) {
      ++number;
      const std::string text =
          number <= 9 ? fmt::format("{}  {}", number, info.label) : fmt::format("    {}", info.label);
      if (ImGui::Selectable(text.c_str(), info.view == session.view)) {
        session.view = info.view;
        session.viewDirty = true;
      }
    }
    ImGui::EndCombo();
  }
};

}  // namespace

std::unique_ptr<Panel> makeViewPanel() {
  return std::make_unique<ViewPanel>();
}

}  // namespace irad
