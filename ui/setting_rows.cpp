#include "ui/setting_rows.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "gi/setting_words.h"
#include "renderer/base/error.h"
#include "ui/imgui.h"
#include "ui/session.h"
#include "ui/theme.h"
#include "ui/unsaved.h"
#include "ui/widgets.h"

namespace irad {
namespace {

std::string format(const SettingRange& range, const char* number) {
  if (std::string_view(range.unit) == "degrees") return std::string(number) + "\u00B0";
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

/// With what it is about.
std::string groupTooltip(std::string_view group) {
  return fmt::format("{}: the settings {}.*; coloured where one is changed", settingGroupHelp(group), group);
}

/// Its right end is at `end`.
bool resetButton(float end, float height, const char* help) {
  const float width = ImGui::GetFrameHeight();
  ImGui::SameLine(end - width);
  const float padding = std::max(0.5f * (height - ImGui::GetFontSize()), 0.0f);  // the glyph stays in the middle
  ImGui::PushStyleVar(ImGuiStyleVar_FramePadding, {ImGui::GetStyle().FramePadding.x, padding});
  const bool pressed = ImGui::Button((std::string(resetGlyph()) + "###reset").c_str(), {width, height});
  ImGui::PopStyleVar();
  helpTooltip(help);
  return pressed;
}

/// In the colour of edited settings where it holds an edited one, and then with a button that resets them. True while
/// the group is unfolded. Of folded ones two share a line: `beside` says that the left half holds one already.
bool groupHeader(const std::string& group, bool edited, bool found, Settings& settings, const Settings& defaults,
                 std::set<std::string>& folded, bool& beside) {
  const std::string title = "Settings/" + group;
  const bool half = !found && folded.contains(title), right = half && beside;
  const float start = ImGui::GetCursorPosX(), width = ImGui::GetContentRegionAvail().x;
  const float end = start + (half && !right ? 0.5f * width : width);
  if (right) ImGui::SameLine(start + 0.5f * width);
  ImGui::SetNextItemOpen(!half);
  ImGui::PushStyleColor(ImGuiCol_Text, edited ? theme::accent : theme::text);
  const bool open =
      ImGui::TreeNodeEx(group.c_str(), ImGuiTreeNodeFlags_NoTreePushOnOpen | ImGuiTreeNodeFlags_AllowItemOverlap |
                                           (half ? 0 : ImGuiTreeNodeFlags_SpanAvailWidth));
  ImGui::PopStyleColor();
  beside = half && !right && !open;
  helpTooltip([&] { return groupTooltip(group); });
  if (!found) keepFolded(folded, title, open);
  if (!edited) return open;
  ImGui::PushID(group.c_str());
  if (resetButton(end, ImGui::GetTextLineHeight(), "All of this group back to their defaults"))
    for (const Setting& setting : settingTable())
      if (setting.group() == group) setting.set(settings, setting.get(defaults));
  ImGui::PopID();
  return open;
}

/// Label, widget, reset.
void row(const Setting& setting, Settings& settings, const Settings& defaults, const Settings* built = nullptr) {
  const bool waits = built && setting.redo < Redo::Shade && setting.get(settings) != setting.get(*built);
  const bool edited = setting.get(settings) != setting.get(defaults);
  ImGui::PushID(setting.name);
  const float start = ImGui::GetCursorPosX();
  const float width = ImGui::GetContentRegionAvail().x;
  const float button = ImGui::GetFrameHeight();
  const float gap = ImGui::GetStyle().ItemInnerSpacing.x;
  ImGui::AlignTextToFramePadding();
  if (edited || waits) ImGui::PushStyleColor(ImGuiCol_Text, waits ? theme::warning : theme::accent);
  const std::string name = (waits ? "\u00B7 " : "") + settingLabel(setting.name);
  const float words = std::clamp(ImGui::CalcTextSize(name.c_str()).x + gap, width * kLabelShare, width * 0.6f);
  clippedText(name, words - gap);
  if (edited || waits) ImGui::PopStyleColor();
  const auto help = [&] {
    std::string text = fmt::format("{}\n{}\nAllowed: {}. Default: {}", setting.name, setting.help, setting.allowed(),
                                   setting.text(defaults));
    if (waits) text += fmt::format("\nNot applied yet: built with {}", setting.text(*built));
    if (setting.redo != Redo::Nothing) text += fmt::format("\nA change redoes: {}", nameOf(setting.redo));
    return text;
  };
  helpTooltip(help);
  ImGui::SameLine(start + words);
  ImGui::SetNextItemWidth(width - words - button - gap);
  edit(setting, settings);
  helpTooltip(help);
  if (edited &&
      resetButton(start + width, button, fmt::format("Back to the default, {}", setting.text(defaults)).c_str()))
    setting.set(settings, setting.get(defaults));
  ImGui::PopID();
}

}  // namespace

std::vector<std::string> settingGroups() {
  std::vector<std::string> groups;
  for (const Setting& setting : settingTable())
    if (groups.empty() || groups.back() != setting.group()) groups.emplace_back(setting.group());
  return groups;
}

bool SettingFilter::passes(const Setting& setting, const Settings& settings, const Settings& defaults) const {
  if (changedOnly && setting.get(settings) == setting.get(defaults)) return false;
  const auto lower = [](std::string text) {
    for (char& c : text)
      if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
    return text;
  };
  // "jfa_pass" is found by "jfa pass" too.
  const std::string text =
      lower(fmt::format("{} {} {} {}", setting.name, setting.group(), settingLabel(setting.name), setting.help));
  std::string wanted = lower(words);
  while (!wanted.empty()) {
    const size_t end = std::min(wanted.find(' '), wanted.size());
    if (text.find(wanted.substr(0, end)) == std::string::npos) return false;
    wanted.erase(0, std::min(end + 1, wanted.size()));
  }
  return true;
}

bool settingRows(Settings& settings, const Settings& defaults, std::set<std::string>& folded,
                 const SettingFilter& filter, const Settings* built) {
  const std::set<std::string_view> edited = editedGroups(settings, defaults);
  std::string_view group;
  bool open = true, any = false, beside = false;
  for (const Setting& setting : settingTable()) {
    if (filter.on() && !filter.passes(setting, settings, defaults)) continue;
    any = true;
    if (setting.group() != group) {
      group = setting.group();
      open = groupHeader(std::string(group), edited.contains(group), filter.on(), settings, defaults, folded, beside);
    }
    if (!open) continue;
    // A row that is scrolled out of view is but room; what is being edited stays.
    const ImVec2 room{1, ImGui::GetFrameHeight()};
    if (ImGui::IsRectVisible(room) || ImGui::IsAnyItemActive() || Controls::current())
      row(setting, settings, defaults, built);
    else
      ImGui::Dummy(room);
  }
  return any;
}

bool differenceTable(const char* id, const Settings& a, const Settings& b, const char* titleA, const char* titleB) {
  const std::vector<const Setting*> differing = differingSettings(a, b);
  if (differing.empty()) return false;
  if (!ImGui::BeginTable(id, 3, ImGuiTableFlags_RowBg | ImGuiTableFlags_SizingStretchProp)) return true;
  ImGui::TableSetupColumn("setting", 0, 2.2f);
  ImGui::TableSetupColumn(titleA, 0, 1);
  ImGui::TableSetupColumn(titleB, 0, 1);
  ImGui::TableHeadersRow();
  for (const Setting* setting : differing)
    for (const std::string& text : {std::string(setting->name), setting->text(a), setting->text(b)}) {
      ImGui::TableNextColumn();
      clippedText(text, ImGui::GetContentRegionAvail().x);
      helpTooltip(text);
    }
  ImGui::EndTable();
  return true;
}

void sideLine(const Session& session) {
  if (!session.comparison) return;
  ImGui::TextColored(theme::accent, "Of side %s", session.comparison->editsB ? "B" : "A");
  ImGui::tellControl(session.comparison->editsB ? "side B" : "side A");
  helpTooltip(
      "Two sets of settings are compared: what is set and shown here is this side's alone. The panel Compare chooses "
      "the other one.");
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
  helpTooltip("Keeps the settings as a preset under a name of your own; it is then in the list of presets");
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
