#include "ui/setting_rows.h"

#include <fmt/format.h>
#include <imgui.h>
#include <imgui_stdlib.h>

#include <algorithm>
#include <cmath>

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
bool chooseNumber(uint32_t& value, const Meta& meta, uint32_t low, uint32_t high, uint32_t step) {
  const auto shown = [&](uint32_t v) { return fmt::format("{} {}", v, meta.unit); };
  bool changed = false;
  if (!ImGui::BeginCombo("##value", shown(value).c_str())) return false;
  for (uint32_t v = low; v <= high; v += step)
    if (ImGui::Selectable(shown(v).c_str(), v == value)) {
      changed = v != value;
      value = v;
    }
  ImGui::EndCombo();
  return changed;
}

bool edit(uint32_t& value, const Meta& meta) {
  const auto low = static_cast<uint32_t>(meta.min);
  const auto high = static_cast<uint32_t>(meta.max);
  const auto step = std::max(static_cast<uint32_t>(meta.step), 1u);
  if ((high - low) / step < 5) return chooseNumber(value, meta, low, high, step);
  // ImGui's sliders take half the range of their type at most.
  if (high > 0x7FFFFFFFu) return ImGui::InputScalar("##value", ImGuiDataType_U32, &value);
  // A wide range is walked by factors, a narrow one by steps.
  const ImGuiSliderFlags flags =
      ImGuiSliderFlags_AlwaysClamp | (meta.max >= 256 && meta.min > 0 ? ImGuiSliderFlags_Logarithmic : 0);
  if (!ImGui::SliderScalar("##value", ImGuiDataType_U32, &value, &low, &high, format(meta, "%u").c_str(), flags))
    return false;
  value = low + (value - low) / step * step;
  return true;
}

/// Too far apart for a slider: a field that is dragged by shares of its value, or typed into.
constexpr double kDragged = 1e5;

bool edit(float& value, const Meta& meta) {
  const float low = static_cast<float>(meta.min), high = static_cast<float>(meta.max);
  const bool logarithmic = meta.logarithmic;
  if (!logarithmic && meta.max - meta.min > kDragged)
    return ImGui::DragFloat("##value", &value, std::max(std::abs(value) * 0.01f, 0.001f), low, high,
                            format(meta, "%.5g").c_str(), ImGuiSliderFlags_AlwaysClamp);
  return ImGui::SliderFloat("##value", &value, low, high, format(meta, logarithmic ? "%.2g" : "%.2f").c_str(),
                            ImGuiSliderFlags_AlwaysClamp |
                                (logarithmic ? ImGuiSliderFlags_Logarithmic | ImGuiSliderFlags_NoRoundToFormat : 0));
}

bool edit(bool& value, const Meta&) {
  return ImGui::Checkbox("##value", &value);
}

template <class E>
bool choose(uint32_t& value) {
  const auto& names = EnumNames<E>::names;
  bool changed = false;
  if (!ImGui::BeginCombo("##value", names.at(value))) return false;
  for (uint32_t i = 0; i < names.size(); ++i)
    if (ImGui::Selectable(names[i], i == value)) {
      changed = i != value;
      value = i;
    }
  ImGui::EndCombo();
  return changed;
}

std::string label(std::string_view name) {
  std::string text(name.substr(name.find('.') + 1));
  for (char& c : text)
    if (c == '_') c = ' ';
  return text;
}

/// Label, widget, reset. `resettable`: the value differs from its default.
template <class Edit>
bool row(const Meta& meta, bool resettable, bool& reset, Edit&& editValue) {
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
  const bool changed = editValue();
  helpTooltip(meta.redo == Redo::Nothing ? fmt::format("{}\n{}", meta.name, meta.help)
                                         : fmt::format("{}\n{}\nA change redoes: {}", meta.name, meta.help,
                                                       EnumNames<Redo>::names[static_cast<size_t>(meta.redo)]));
  if (resettable) {
    ImGui::SameLine(start + width - button);
    reset = ImGui::Button(resetGlyph(), {button, button});
    helpTooltip("Back to the default");
  }
  ImGui::PopID();
  return changed || reset;
}

template <class T>
bool rowOf(T& value, const T& standard, const Meta& meta, auto&& editValue) {
  bool reset = false;
  const bool changed = row(meta, value != standard, reset, editValue);
  if (reset) value = standard;
  return changed;
}

/// One overload per kind of member that visit() hands out.
struct RowDrawer {
  Settings& settings;
  Settings& defaults;

  bool operator()(bool& v, const Meta& m) const { return plain(v, m); }
  bool operator()(uint32_t& v, const Meta& m) const { return plain(v, m); }
  bool operator()(float& v, const Meta& m) const { return plain(v, m); }
  bool operator()(BoolRef ref, const Meta& m) const {
    return rowOf(ref.value, twin(settings, defaults, ref.value), m, [&] {
      bool on = ref.value != 0;
      const bool changed = edit(on, m);
      ref.value = on;
      return changed;
    });
  }
  template <class E>
  bool operator()(EnumRef<E> ref, const Meta& m) const {
    return rowOf(ref.value, twin(settings, defaults, ref.value), m, [&] { return choose<E>(ref.value); });
  }
  template <class E>
  requires std::is_enum_v<E>
  bool operator()(E& value, const Meta& m) const {
    return rowOf(value, twin(settings, defaults, value), m, [&] {
      auto index = static_cast<uint32_t>(value);
      const bool changed = choose<E>(index);
      value = static_cast<E>(index);
      return changed;
    });
  }
  template <class T>
  bool plain(T& value, const Meta& m) const {
    return rowOf(value, twin(settings, defaults, value), m, [&] { return edit(value, m); });
  }
};

}  // namespace

bool settingRows(Settings& settings, const Settings& defaults, std::string_view prefix) {
  Settings standard = defaults;
  const RowDrawer draw{settings, standard};
  bool changed = false, open = true;
  std::string_view group;
  visit(settings, [&](auto&& member, const Meta& meta) {
    const std::string_view name = meta.name;
    if (!name.starts_with(prefix)) return;
    const std::string_view own = name.substr(0, name.find('.'));
    if (prefix.empty() && own != group) {
      group = own;
      open = ImGui::TreeNodeEx(std::string(own).c_str(), ImGuiTreeNodeFlags_DefaultOpen | ImGuiTreeNodeFlags_Framed |
                                                             ImGuiTreeNodeFlags_NoTreePushOnOpen);
    }
    if (open) changed |= draw(member, meta);
  });
  return changed;
}

bool settingRow(Settings& settings, const Settings& defaults, std::string_view name) {
  Settings standard = defaults;
  const RowDrawer draw{settings, standard};
  bool changed = false;
  visit(settings, [&](auto&& member, const Meta& meta) {
    if (name == meta.name) changed |= draw(member, meta);
  });
  return changed;
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
