// Every setting of gi/settings.h, generated from their table.

#include "renderer/base/error.h"
#include "ui/imgui.h"
#include "ui/panel.h"
#include "ui/setting_rows.h"
#include "ui/theme.h"
#include "ui/widgets.h"

namespace irad {
namespace {

class SettingsPanel : public Panel {
 public:
  const char* title() const override { return "Settings"; }
  Region region() const override { return Region::Left; }

  void draw(Session& session) override {
    drawPresets(session);
    drawNext(session);
    settingRows(session.edited, session.defaults, session.preferences.folded);
  }

 private:
  std::string name_;  ///< of a preset, being typed

  /// A preset is applied over the settings; those that it leaves alone keep their values (gi/settings.h).
  void drawPresets(Session& session) {
    const float button = ImGui::CalcTextSize("Save\u2026").x + 2 * ImGui::GetStyle().FramePadding.x;
    ImGui::SetNextItemWidth(ImGui::GetContentRegionAvail().x - button - ImGui::GetStyle().ItemSpacing.x);
    choosePreset(session);
    ImGui::SameLine();
    savePresetButton("Save\u2026", button, name_, session, session.edited);
  }

  static void choosePreset(Session& session) {
    if (!ImGui::BeginCombo("##preset", "Preset\u2026")) return;
    for (const std::string& name : presetNames())
      if (ImGui::Selectable(name.c_str())) {
        applyPreset(session.edited, name, session.context.device.isCpu);
        session.saved = session.edited;
        session.history.call("preset " + name);
      }
    ImGui::Separator();
    if (ImGui::Selectable("defaults of this device")) {
      session.saved = session.edited = session.defaults;
      session.history.call("defaults of this device");
    }
    if (!session.presets.names().empty()) ImGui::Separator();
    for (const std::string& name : session.presets.names())
      if (ImGui::Selectable(name.c_str())) apply(session, name);
    ImGui::EndCombo();
  }

  static void apply(Session& session, const std::string& name) {
    try {
      session.presets.apply(session.edited, name);
      session.saved = session.edited;
      session.history.call("preset " + name);
    } catch (const Error& error) {
      session.error(error.what());
    }
  }

  /// What an edit will redo, before it is redone: always one line, so that rows do not jump while a value is dragged.
  static void drawNext(Session& session) {
    const auto line = [](const ImVec4& color, const std::string& text) {
      ImGui::PushStyleColor(ImGuiCol_Text, color);
      clippedText(text, ImGui::GetContentRegionAvail().x);
      ImGui::PopStyleColor();
    };
    if (session.next < Redo::Shade)
      line(theme::accent, "next: " + stagesFrom(session.next, arrowGlyph()));
    else if (session.halted)
      line(theme::warning, "not rebuilt: the picture shows the old state");
    else
      line(theme::dim, "up to date");
    if (session.halted && ImGui::Button("Rebuild", {-1, 0})) session.rebuild = true;
  }
};

}  // namespace

std::unique_ptr<Panel> makeSettingsPanel() {
  return std::make_unique<SettingsPanel>();
}

}  // namespace irad
