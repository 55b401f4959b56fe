// Every setting of gi/settings.h, generated from their table.
#include <optional>
#include <utility>

#include "renderer/base/error.h"

#include "ui/imgui.h"
#include "ui/panel.h"
#include "ui/setting_rows.h"
#include "ui/theme.h"
#include "ui/unsaved.h"
#include "ui/widgets.h"

namespace irad {
namespace {

class SettingsPanel : public Panel {
 public:
  const char* title() const override { return "Settings"; }
  const char* help() const override {
    return "How light is computed and shown. What is not the default is coloured, with a button that resets it.";
  }
  Region region() const override { return Region::Left; }

  void draw(Session& session) override {
    sideLine(session);
    drawPresets(session);
    drawNext(session);
    drawSearch(session);
    if (!settingRows(session.edited, session.defaults, session.preferences.folded, filter_,
                     session.pending && session.built ? &session.built->settings : nullptr))
      ImGui::TextColored(theme::dim, filter_.changedOnly ? "none that is changed" : "none of that name or meaning");
  }

 private:
  std::string name_;  ///< of a preset, being typed
  SettingFilter filter_;
  std::optional<Settings> ofPreset_;  ///< the settings that preset_ was found for
  std::string preset_;

  void drawSearch(Session& session) {
    const float box = ImGui::GetFrameHeight() + ImGui::GetStyle().ItemInnerSpacing.x + ImGui::CalcTextSize("changed").x;
    ImGui::SetNextItemWidth(ImGui::GetContentRegionAvail().x - box - ImGui::GetStyle().ItemSpacing.x);
    if (std::exchange(session.findSetting, false)) {
      ImGui::SetKeyboardFocusHere();
      ImGui::SetScrollHereY(0);
    }
    ImGui::InputTextWithHint("##search", "search (Ctrl + F)", &filter_.words);
    helpTooltip("Words of names or descriptions: settings that hold all of them are shown");
    ImGui::SameLine();
    ImGui::Checkbox("changed", &filter_.changedOnly);
    helpTooltip("Only those that are not this device's defaults");
  }

  /// The name of the preset that these settings are; found anew when they have changed.
  const std::string& presetShown(const Session& session) {
    if (ofPreset_ && sameSettings(*ofPreset_, session.edited)) return preset_;
    ofPreset_ = session.edited;
    const auto is = [&](auto&& apply) {
      Settings applied = session.edited;
      apply(applied);
      return sameSettings(applied, session.edited);
    };
    preset_ = "Preset: none, edited";
    if (sameSettings(session.defaults, session.edited)) preset_ = "Preset: defaults of this device";
    for (const std::string& name : session.presets.names()) try {
        if (is([&](Settings& s) { session.presets.apply(s, name); })) preset_ = "Preset: " + name;
      } catch (const Error&) {
        continue;  // choosing it says what is wrong
      }
    for (const std::string& name : presetNames())
      if (is([&](Settings& s) { applyPreset(s, name, session.context.device.isCpu); })) preset_ = "Preset: " + name;
    return preset_;
  }

  /// A preset is applied over the settings; those that it leaves alone keep their values (gi/settings.h).
  void drawPresets(Session& session) {
    const float button = ImGui::CalcTextSize("Save\u2026").x + 2 * ImGui::GetStyle().FramePadding.x;
    ImGui::SetNextItemWidth(ImGui::GetContentRegionAvail().x - button - ImGui::GetStyle().ItemSpacing.x);
    choosePreset(session);
    ImGui::SameLine();
    savePresetButton("Save\u2026", button, name_, session, session.edited);
  }

  void choosePreset(Session& session) {
    if (!ImGui::BeginCombo("##preset", presetShown(session).c_str())) {
      helpTooltip([&] {
        return presetShown(session) +
               "\nThe preset that the settings are, or the one to apply. Presets set how light is computed; the view, "
               "the seed, exposure, sky and scene.* stay.";
      });
      return;
    }
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
    if (session.pending)
      line(theme::warning, "waits: " + stagesFrom(session.next, arrowGlyph()));
    else if (session.next < Redo::Shade)
      line(theme::accent, "next: " + stagesFrom(session.next, arrowGlyph()));
    else if (session.halted)
      line(theme::warning, "not rebuilt: the picture shows the old state");
    else
      line(theme::dim, session.built ? "up to date" : "nothing built yet");
    drawCost(session, line);
    if (session.halted) {
      if (ImGui::Button("Rebuild", {-1, 0})) session.rebuild = true;
      helpTooltip("Tries again what failed or was cancelled");
    }
    ImGui::Checkbox("apply by hand", &session.preferences.applyByHand);
    helpTooltip(
        "Settings that rebuild wait, marked in the list, until Apply builds once for all of them. What only the "
        "picture shows is taken at once.");
    const float button = ImGui::CalcTextSize("Apply").x + 4 * ImGui::GetStyle().FramePadding.x;
    ImGui::SameLine();
    // At the line's end; below where large text leaves no room.
    if (const float room = ImGui::GetContentRegionAvail().x; room >= button)
      ImGui::SetCursorPosX(ImGui::GetCursorPosX() + room - button);
    else
      ImGui::NewLine();
    ImGui::BeginDisabled(!session.pending);
    if (ImGui::Button("Apply", {button, 0})) session.applyNow = true;
    ImGui::EndDisabled();
    helpTooltip("Builds once for all settings that wait");
  }

  /// What a rebuild will take, or the last one took beside what was predicted of it: always one line, too.
  template <class Line>
  static void drawCost(const Session& session, const Line& line) {
    const uint64_t budget = session.context.device.memory().budget();
    const bool due = session.next < Redo::Shade;
    std::string text, compiled;
    bool much = false;
    if (due && session.forecast) {
      much = session.forecast->bytes > budget;
      text = "predicted " + costText(*session.forecast) + (much ? ": more than there is" : "");
    } else if (due) {
      text = "no prediction: not timed yet";
    } else if (session.lastBuild) {
      const auto& [predicted, took, compileMs] = *session.lastBuild;
      text = "took " + costText(took) + (predicted ? "; predicted " + costText(*predicted) : "");
      compiled = fmt::format("; {} of it for compiling shaders", durationText(compileMs));
    }
    line(much ? theme::error : due ? theme::accent : theme::dim, text);
    ImGui::tellControl("cost", due);
    helpTooltip(
        text + compiled +
        "\nSeconds until the new light is seen first, and the device memory then in use (MiB of 1,048,576 "
        "bytes). Predicted of the stages that are redone, from what each took last, by the growth with "
        "voxel.resolution and matrix.rays; what other settings change is not foreseen, nor shaders that have to be "
        "compiled first.");
  }
};

}  // namespace

std::unique_ptr<Panel> makeSettingsPanel() {
  return std::make_unique<SettingsPanel>();
}

}  // namespace irad
