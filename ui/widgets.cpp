#include "ui/widgets.h"

#include <fmt/format.h>
#include <imgui.h>
#include <imgui_stdlib.h>

#include <algorithm>

#include "renderer/error.h"
#include "ui/session.h"
#include "ui/theme.h"

namespace irad {

namespace {

/// Share of a row that the label takes.
constexpr float kLabelShare = 0.42f;

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

bool edit(float& value, const Meta& meta) {
  const float low = static_cast<float>(meta.min), high = static_cast<float>(meta.max);
  const bool logarithmic = meta.logarithmic;
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

void valueRow(const char* label, const std::string& value) {
  const float start = ImGui::GetCursorPosX();
  const float width = ImGui::GetContentRegionAvail().x;
  ImGui::TextColored(theme::dim, "%s", label);
  ImGui::SameLine(start + width * kLabelShare);
  clippedText(value, width * (1 - kLabelShare));
}

void fieldLabel(const char* label, const std::string& help) {
  const float start = ImGui::GetCursorPosX();
  const float width = ImGui::GetContentRegionAvail().x;
  ImGui::AlignTextToFramePadding();
  clippedText(label, width * kLabelShare);
  if (!help.empty()) helpTooltip(help);
  ImGui::SameLine(start + width * kLabelShare);
  ImGui::SetNextItemWidth(width * (1 - kLabelShare));
}

void helpTooltip(const std::string& text) {
  if (!ImGui::IsItemHovered()) return;
  ImGui::BeginTooltip();
  ImGui::PushTextWrapPos(ImGui::GetFontSize() * 24);
  ImGui::TextUnformatted(text.c_str());
  ImGui::PopTextWrapPos();
  ImGui::EndTooltip();
}

void clippedText(const std::string& text, float width) {
  if (ImGui::CalcTextSize(text.c_str()).x <= width) {
    ImGui::TextUnformatted(text.c_str());
    return;
  }
  std::string cut = text;
  while (!cut.empty() && ImGui::CalcTextSize((cut + "\u2026").c_str()).x > width) {
    // Drop one code point: its continuation bytes, then its first.
    while (!cut.empty() && (static_cast<unsigned char>(cut.back()) & 0xC0) == 0x80) cut.pop_back();
    if (!cut.empty()) cut.pop_back();
  }
  ImGui::TextUnformatted((cut + "\u2026").c_str());
  helpTooltip(text);
}

void rightText(const std::string& text) {
  const float slack = ImGui::GetContentRegionAvail().x - ImGui::CalcTextSize(text.c_str()).x;
  if (slack > 0) ImGui::SetCursorPosX(ImGui::GetCursorPosX() + slack);
  ImGui::TextUnformatted(text.c_str());
}

bool beginNumberTable(const char* id, const std::vector<const char*>& columns, const std::vector<size_t>& words) {
  if (!ImGui::BeginTable(id, static_cast<int>(columns.size()), ImGuiTableFlags_RowBg | ImGuiTableFlags_ScrollY,
                         ImGui::GetContentRegionAvail()))
    return false;
  const auto isWord = [&](size_t i) { return std::find(words.begin(), words.end(), i) != words.end(); };
  const float number = ImGui::CalcTextSize("00000.0").x;
  ImGui::TableSetupScrollFreeze(0, 1);
  for (size_t i = 0; i < columns.size(); ++i)
    ImGui::TableSetupColumn(columns[i],
                            isWord(i) ? ImGuiTableColumnFlags_WidthStretch : ImGuiTableColumnFlags_WidthFixed,
                            isWord(i) ? 1.0f : number);
  ImGui::TableNextRow(ImGuiTableRowFlags_Headers);
  ImGui::PushStyleColor(ImGuiCol_Text, theme::dim);
  for (size_t i = 0; i < columns.size(); ++i) {
    ImGui::TableNextColumn();
    if (isWord(i))
      clippedText(columns[i], ImGui::GetContentRegionAvail().x);
    else
      rightText(columns[i]);
  }
  ImGui::PopStyleColor();
  return true;
}

bool Refresh::due(const Session& session) {
  const bool resting = session.asleep() && !session.viewDirty && !session.work;
  const double now = ImGui::GetTime();
  if (!resting && now - last_ < 0.25) return false;
  last_ = now;
  return true;
}

std::string prettyUnit(std::string_view unit) {
  std::string text;
  for (size_t i = 0; i < unit.size(); ++i)
    if (unit.substr(i, 2) == "^2") {
      text += "\u00B2";
      ++i;
    } else {
      text += unit[i];
    }
  return text;
}

std::string milliseconds(double value) {
  return value < 10     ? fmt::format("{:.2f}", value)
         : value < 1000 ? fmt::format("{:.1f}", value)
                        : fmt::format("{:.0f}", value);
}

std::string mebibytes(uint64_t bytes) {
  const double value = static_cast<double>(bytes) / (1024.0 * 1024.0);
  return value < 9.95 ? fmt::format("{:.2f} MiB", value) : fmt::format("{:.1f} MiB", value);
}

std::string shortNumber(double value) {
  return fmt::format("{:.3g}", value);
}

std::string withThousands(uint64_t value) {
  std::string digits = fmt::format("{}", value);
  for (auto i = static_cast<ptrdiff_t>(digits.size()) - 3; i > 0; i -= 3) digits.insert(static_cast<size_t>(i), 1, ',');
  return digits;
}

}  // namespace irad
