#include "ui/setting_rows.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "renderer/base/error.h"
#include "ui/imgui.h"
#include "ui/session.h"
#include "ui/theme.h"
#include "ui/widgets.h"

namespace irad {
namespace {

std::string format(const SettingRange& range, const char* number) {
  const std::string unit = prettyUnit(range.unit);  // no unit holds a percent sign, which would be read as a format
  return unit.empty() ? number : fmt::format("{} {}", number, unit);
}

/// The few values that a narrow range allows, as a list.
void chooseNumber(uint32_t& value, const SettingRange& range, uint32_t low, uint32_t high, uint32_t step) {
  const auto shown = [&](uint32_t v) { return fmt::format("{} {}", v, range.unit); };
  if (!ImGui::BeginCombo("##", shown(value).c_str())) return;
  for (uint32_t v = low; v <= high; v += step)
    if (ImGui::Selectable(fmt::format("{}###{}", shown(v), v).c_str(), v == value)) value = v;
  ImGui::EndCombo();
}

void edit(uint32_t& value, const SettingRange& range) {
  const auto low = static_cast<uint32_t>(range.min);
  const auto high = static_cast<uint32_t>(range.max);
  const auto step = std::max(static_cast<uint32_t>(range.step), 1u);
  if ((high - low) / step < 5) return chooseNumber(value, range, low, high, step);
  // ImGui's sliders take half the range of their type at most.
  if (high > 0x7FFFFFFFu) {
    ImGui::InputScalar("##", ImGuiDataType_U32, &value);
    return;
  }
  // A wide range is walked by factors, a narrow one by steps.
  const ImGuiSliderFlags flags =
      ImGuiSliderFlags_AlwaysClamp | (range.max >= 256 && range.min > 0 ? ImGuiSliderFlags_Logarithmic : 0);
  if (ImGui::SliderScalar("##", ImGuiDataType_U32, &value, &low, &high, format(range, "%u").c_str(), flags))
    value = low + (value - low) / step * step;
}

/// Too far apart for a slider: a field that is dragged by shares of its value, or typed into.
constexpr double kDragged = 1e5;

void edit(float& value, const SettingRange& range) {
  const float low = static_cast<float>(range.min), high = static_cast<float>(range.max);
  if (!range.logarithmic && range.max - range.min > kDragged)
    ImGui::DragFloat("##", &value, std::max(std::abs(value) * 0.01f, 0.001f), low, high, format(range, "%.5g").c_str(),
                     ImGuiSliderFlags_AlwaysClamp);
  else
    ImGui::SliderFloat("##", &value, low, high, format(range, range.logarithmic ? "%.2g" : "%.2f").c_str(),
                       ImGuiSliderFlags_AlwaysClamp |
                           (range.logarithmic ? ImGuiSliderFlags_Logarithmic | ImGuiSliderFlags_NoRoundToFormat : 0));
}

void choose(size_t& value, std::span<const char* const> names, ImGuiComboFlags flags = 0) {
  IRAD_CHECK_OP(value, <, names.size());
  if (!ImGui::BeginCombo("##", names[value], flags)) return;
  for (size_t i = 0; i < names.size(); ++i)
    if (ImGui::Selectable(names[i], i == value)) value = i;
  ImGui::EndCombo();
}

/// The widget that suits the kind of setting.
void edit(const Setting& setting, Settings& settings) {
  const double value = setting.get(settings);
  switch (setting.kind) {
    case SettingKind::integer: {
      auto number = static_cast<uint32_t>(value);
      edit(number, setting.range);
      return setting.set(settings, number);
    }
    case SettingKind::number: {
      auto number = static_cast<float>(value);
      edit(number, setting.range);
      return setting.set(settings, number);
    }
    case SettingKind::toggle: {
      bool on = value != 0;
      ImGui::Checkbox("##", &on);
      return setting.set(settings, on);
    }
    case SettingKind::choice: {
      auto index = static_cast<size_t>(value);
      choose(index, setting.choices);
      return setting.set(settings, static_cast<double>(index));
    }
  }
}

/// The groups with a setting that is not its default.
std::set<std::string_view> editedGroups(const Settings& settings, const Settings& defaults) {
  std::set<std::string_view> groups;
  for (const Setting& setting : settingTable())
    if (setting.get(settings) != setting.get(defaults)) groups.insert(setting.group());
  return groups;
}

/// In the colour of edited settings where it holds an edited one. True while the group is unfolded.
bool groupHeader(const std::string& group, bool edited, std::set<std::string>& folded) {
  const std::string title = "Settings/" + group;
  ImGui::SetNextItemOpen(!folded.contains(title));
  ImGui::PushStyleColor(ImGuiCol_Text, edited ? theme::accent : theme::text);
  const bool open =
      ImGui::TreeNodeEx(group.c_str(), ImGuiTreeNodeFlags_NoTreePushOnOpen | ImGuiTreeNodeFlags_SpanAvailWidth);
  ImGui::PopStyleColor();
  keepFolded(folded, title, open);
  return open;
}

std::string label(std::string_view name) {
  std::string text(name.substr(name.find('.') + 1));
  for (char& c : text)
    if (c == '_') c = ' ';
  return text;
}

/// Label, widget, reset.
void row(const Setting& setting, Settings& settings, const Settings& defaults) {
  const bool edited = setting.get(settings) != setting.get(defaults);
  ImGui::PushID(setting.name);
  const float start = ImGui::GetCursorPosX();
  const float width = ImGui::GetContentRegionAvail().x;
  const float button = ImGui::GetFrameHeight();
  const float gap = ImGui::GetStyle().ItemInnerSpacing.x;
  ImGui::AlignTextToFramePadding();
  if (edited) ImGui::PushStyleColor(ImGuiCol_Text, theme::accent);
  clippedText(label(setting.name), width * kLabelShare - gap);
  if (edited) ImGui::PopStyleColor();
  const std::string help = fmt::format("{}\n{}", setting.name, setting.help);
  helpTooltip(help);
  ImGui::SameLine(start + width * kLabelShare);
  ImGui::SetNextItemWidth(width * (1 - kLabelShare) - button - gap);
  edit(setting, settings);
  helpTooltip(setting.redo == Redo::Nothing ? help
                                            : fmt::format("{}\nA change redoes: {}", help, nameOf(setting.redo)));
  if (edited) {
    ImGui::SameLine(start + width - button);
    if (ImGui::Button((std::string(resetGlyph()) + "###reset").c_str(), {button, button}))
      setting.set(settings, setting.get(defaults));
    helpTooltip("Back to the default");
  }
  ImGui::PopID();
}

}  // namespace

std::vector<std::string> settingGroups() {
  std::vector<std::string> groups;
  for (const Setting& setting : settingTable())
    if (groups.empty() || groups.back() != setting.group()) groups.emplace_back(setting.group());
  return groups;
}

void settingRows(Settings& settings, const Settings& defaults, std::set<std::string>& folded) {
  const std::set<std::string_view> edited = editedGroups(settings, defaults);
  std::string_view group;
  bool open = true;
  for (const Setting& setting : settingTable()) {
    if (setting.group() != group) {
      group = setting.group();
      open = groupHeader(std::string(group), edited.contains(group), folded);
    }
    if (open) row(setting, settings, defaults);
  }
}

void settingRow(Settings& settings, const Settings& defaults, std::string_view name) {
  row(findSetting(name), settings, defaults);
}

void settingArrow(Settings& settings, std::string_view name) {
  const Setting& setting = findSetting(name);
  auto index = static_cast<size_t>(setting.get(settings));
  choose(index, setting.choices, ImGuiComboFlags_NoPreview);
  setting.set(settings, static_cast<double>(index));
}

void savePresetButton(const char* label, float width, std::string& name, Session& session, const Settings& settings) {
  const bool pressed = ImGui::Button(label, {width, 0});
  ImGui::PushID(label);
  if (pressed) ImGui::OpenPopup("name");
  if (ImGui::BeginPopup("name")) {
    ImGui::TextUnformatted("Name of the preset");
    if (ImGui::IsWindowAppearing()) ImGui::SetKeyboardFocusHere();
    const bool entered = ImGui::InputText("##name", &name, ImGuiInputTextFlags_EnterReturnsTrue);
    if (ImGui::Button("Save") || entered) {
      ImGui::CloseCurrentPopup();
      try {
        session.note(fmt::format("Saved {}", session.presets.save(name, settings).string()));
        session.settingsSaved(settings);
      } catch (const Error& error) {
        session.error(error.what());
      }
    }
    ImGui::EndPopup();
  }
  ImGui::PopID();
}

}  // namespace irad
