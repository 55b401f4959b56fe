#include "ui/setting_rows.h"

#include <fmt/format.h>
#include <imgui.h>
#include <imgui_stdlib.h>

#include <algorithm>
#include <cmath>
#include <type_traits>

#include "renderer/error.h"
#include "ui/session.h"
#include "ui/theme.h"
#include "ui/widgets.h"

namespace irad {
namespace {

/// The member of `other` that stands where `member` stands in `settings`.
template <class T>
T& twin(Settings& settings, Settings& other, T& member) {
  const auto offset = reinterpret_cast<std::byte*>(&member) - reinterpret_cast<std::byte*>(&settings);
  return *reinterpret_cast<T*>(reinterpret_cast<std::byte*>(&other) + offset);
}

std::string format(const Meta& meta, const char* number) {
  const std::string unit = prettyUnit(meta.unit);  // no unit holds a percent sign, which the format would read
  return unit.empty() ? number : fmt::format("{} {}", number, unit);
}

/// The few values that a narrow range allows, as a list.
void chooseNumber(uint32_t& value, const Meta& meta, uint32_t low, uint32_t high, uint32_t step) {
  const auto shown = [&](uint32_t v) { return fmt::format("{} {}", v, meta.unit); };
  if (!ImGui::BeginCombo("##value", shown(value).c_str())) return;
  for (uint32_t v = low; v <= high; v += step)
    if (ImGui::Selectable(shown(v).c_str(), v == value)) value = v;
  ImGui::EndCombo();
}

void edit(uint32_t& value, const Meta& meta) {
  const auto low = static_cast<uint32_t>(meta.min);
  const auto high = static_cast<uint32_t>(meta.max);
  const auto step = std::max(static_cast<uint32_t>(meta.step), 1u);
  if ((high - low) / step < 5) return chooseNumber(value, meta, low, high, step);
  // ImGui's sliders take half the range of their type at most.
  if (high > 0x7FFFFFFFu) {
    ImGui::InputScalar("##value", ImGuiDataType_U32, &value);
    return;
  }
  // A wide range is walked by factors, a narrow one by steps.
  const ImGuiSliderFlags flags =
      ImGuiSliderFlags_AlwaysClamp | (meta.max >= 256 && meta.min > 0 ? ImGuiSliderFlags_Logarithmic : 0);
  if (ImGui::SliderScalar("##value", ImGuiDataType_U32, &value, &low, &high, format(meta, "%u").c_str(), flags))
    value = low + (value - low) / step * step;
}

/// Too far apart for a slider: a field that is dragged by shares of its value, or typed into.
constexpr double kDragged = 1e5;

void edit(float& value, const Meta& meta) {
  const float low = static_cast<float>(meta.min), high = static_cast<float>(meta.max);
  const bool logarithmic = meta.logarithmic;
  if (!logarithmic && meta.max - meta.min > kDragged)
    ImGui::DragFloat("##value", &value, std::max(std::abs(value) * 0.01f, 0.001f), low, high,
                     format(meta, "%.5g").c_str(), ImGuiSliderFlags_AlwaysClamp);
  else
    ImGui::SliderFloat("##value", &value, low, high, format(meta, logarithmic ? "%.2g" : "%.2f").c_str(),
                       ImGuiSliderFlags_AlwaysClamp |
                           (logarithmic ? ImGuiSliderFlags_Logarithmic | ImGuiSliderFlags_NoRoundToFormat : 0));
}

void edit(bool& value, const Meta&) {
  ImGui::Checkbox("##value", &value);
}

template <class E>
void choose(uint32_t& value, ImGuiComboFlags flags = 0) {
  const auto& names = EnumNames<E>::names;
  if (!ImGui::BeginCombo("##value", names.at(value), flags)) return;
  for (uint32_t i = 0; i < names.size(); ++i)
    if (ImGui::Selectable(names[i], i == value)) value = i;
  ImGui::EndCombo();
}

template <class E>
void chooseEnum(E& value, ImGuiComboFlags flags = 0) {
  auto index = static_cast<uint32_t>(value);
  choose<E>(index, flags);
  value = static_cast<E>(index);
}

std::string_view groupOf(const Meta& meta) {
  const std::string_view name = meta.name;
  return name.substr(0, name.find('.'));
}

/// Those with a setting that is not its default.
std::set<std::string_view> editedGroups(Settings& settings, Settings& defaults) {
  std::set<std::string_view> groups;
  visit(settings, [&](auto&& member, const Meta& meta) {
    bool edited;
    if constexpr (requires { member.value; })
      edited = member.value != twin(settings, defaults, member.value);
    else
      edited = member != twin(settings, defaults, member);
    if (edited) groups.insert(groupOf(meta));
  });
  return groups;
}

/// In the colour of edited settings where it holds one. True while the group is unfolded.
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

/// Label, widget, reset. `resettable`: the value differs from its default. True when it is to be reset.
template <class Edit>
bool row(const Meta& meta, bool resettable, Edit&& editValue) {
  ImGui::PushID(meta.name);
  const float start = ImGui::GetCursorPosX();
  const float width = ImGui::GetContentRegionAvail().x;
  const float button = ImGui::GetFrameHeight();
  const float gap = ImGui::GetStyle().ItemInnerSpacing.x;
  ImGui::AlignTextToFramePadding();
  if (resettable) ImGui::PushStyleColor(ImGuiCol_Text, theme::accent);
  clippedText(label(meta.name), width * kLabelShare - gap);
  if (resettable) ImGui::PopStyleColor();
  helpTooltip(fmt::format("{}\n{}", meta.name, meta.help));
  ImGui::SameLine(start + width * kLabelShare);
  ImGui::SetNextItemWidth(width * (1 - kLabelShare) - button - gap);
  editValue();
  helpTooltip(meta.redo == Redo::Nothing ? fmt::format("{}\n{}", meta.name, meta.help)
                                         : fmt::format("{}\n{}\nA change redoes: {}", meta.name, meta.help,
                                                       EnumNames<Redo>::names[static_cast<size_t>(meta.redo)]));
  bool reset = false;
  if (resettable) {
    ImGui::SameLine(start + width - button);
    reset = ImGui::Button(resetGlyph(), {button, button});
    helpTooltip("Back to the default");
  }
  ImGui::PopID();
  return reset;
}

template <class T>
void rowOf(T& value, const T& standard, const Meta& meta, auto&& editValue) {
  if (row(meta, value != standard, editValue)) value = standard;
}

/// One overload per kind of member that visit() hands out.
struct RowDrawer {
  Settings& settings;
  Settings& defaults;

  void operator()(BoolRef ref, const Meta& m) const {
    rowOf(ref.value, twin(settings, defaults, ref.value), m, [&] {
      bool on = ref.value != 0;
      edit(on, m);
      ref.value = on;
    });
  }
  template <class E>
  void operator()(EnumRef<E> ref, const Meta& m) const {
    rowOf(ref.value, twin(settings, defaults, ref.value), m, [&] { choose<E>(ref.value); });
  }
  template <class T>
  void operator()(T& value, const Meta& m) const {
    rowOf(value, twin(settings, defaults, value), m, [&] {
      if constexpr (std::is_enum_v<T>)
        chooseEnum(value);
      else
        edit(value, m);
    });
  }
};

}  // namespace

std::vector<std::string> settingGroups() {
  std::vector<std::string> groups;
  Settings settings;
  visit(settings, [&](auto&&, const Meta& meta) {
    if (groups.empty() || groups.back() != groupOf(meta)) groups.emplace_back(groupOf(meta));
  });
  return groups;
}

void settingRows(Settings& settings, const Settings& defaults, std::set<std::string>& folded) {
  Settings standard = defaults;
  const RowDrawer draw{settings, standard};
  const std::set<std::string_view> edited = editedGroups(settings, standard);
  std::string_view group;
  bool open = true;
  visit(settings, [&](auto&& member, const Meta& meta) {
    if (groupOf(meta) != group) {
      group = groupOf(meta);
      open = groupHeader(std::string(group), edited.contains(group), folded);
    }
    if (open) draw(member, meta);
  });
}

void settingRow(Settings& settings, const Settings& defaults, std::string_view name) {
  Settings standard = defaults;
  const RowDrawer draw{settings, standard};
  visit(settings, [&](auto&& member, const Meta& meta) {
    if (name == meta.name) draw(member, meta);
  });
}

void settingArrow(Settings& settings, std::string_view name) {
  visit(settings, [&](auto&& member, const Meta& meta) {
    if (name != meta.name) return;
    if constexpr (std::is_enum_v<std::remove_cvref_t<decltype(member)>>) chooseEnum(member, ImGuiComboFlags_NoPreview);
  });
}

void savePresetButton(const char* label, float width, std::string& name, Session& session, const Settings& settings) {
  ImGui::PushID(label);
  if (ImGui::Button(label, {width, 0})) ImGui::OpenPopup("name");
  if (ImGui::BeginPopup("name")) {
    ImGui::TextUnformatted("Name of the preset");
    if (ImGui::IsWindowAppearing()) ImGui::SetKeyboardFocusHere();
    const bool entered = ImGui::InputText("##name", &name, ImGuiInputTextFlags_EnterReturnsTrue);
    if (ImGui::Button("Save") || entered) {
      ImGui::CloseCurrentPopup();
      try {
        session.note(fmt::format("Saved {}", session.presets.save(name, settings).string()));
      } catch (const Error& error) {
        session.error(error.what());
      }
    }
    ImGui::EndPopup();
  }
  ImGui::PopID();
}

}  // namespace irad
