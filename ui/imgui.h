// ImGui as the window's code has it. Inside of namespace irad, `ImGui::` is the namespace below: all of Dear ImGui, but
// whatever makes a control tells its name to Controls, when a test has asked for names.
#pragma once

#include <imgui.h>
#include <imgui_stdlib.h>

#include <utility>

#include "ui/controls.h"

namespace irad::ImGui {

using namespace ::ImGui;

inline void tellControl(const char* label, bool on = false) {
  if (Controls* controls = Controls::current()) controls->add(label, on);
}
/// Something that is drawn and can be taken with the mouse, but is no item.
inline void tellPlace(const char* label, glm::vec2 low, glm::vec2 high, bool on = false) {
  if (Controls* controls = Controls::current()) controls->place(label, on, low, high);
}
inline void enterControls(const char* id) {
  if (Controls* controls = Controls::current()) controls->enter(id);
}
inline void leaveControls() {
  if (Controls* controls = Controls::current()) controls->leave();
}

// ---- Controls ----

inline bool Button(const char* label, const ImVec2& size = ImVec2(0, 0)) {
  const bool pressed = ::ImGui::Button(label, size);
  tellControl(label);
  return pressed;
}
inline bool SmallButton(const char* label) {
  const bool pressed = ::ImGui::SmallButton(label);
  tellControl(label);
  return pressed;
}
inline bool InvisibleButton(const char* label, const ImVec2& size, ImGuiButtonFlags flags = 0) {
  const bool pressed = ::ImGui::InvisibleButton(label, size, flags);
  tellControl(label);
  return pressed;
}
inline bool ArrowButton(const char* label, ImGuiDir direction) {
  const bool pressed = ::ImGui::ArrowButton(label, direction);
  tellControl(label);
  return pressed;
}
inline bool Selectable(const char* label, bool selected = false, ImGuiSelectableFlags flags = 0,
                       const ImVec2& size = ImVec2(0, 0)) {
  const bool pressed = ::ImGui::Selectable(label, selected, flags, size);
  tellControl(label, selected);
  return pressed;
}
inline bool MenuItem(const char* label, const char* keys = nullptr, bool selected = false, bool enabled = true) {
  ::ImGui::BeginDisabled(!enabled);  // for tellControl() too
  const bool pressed = ::ImGui::MenuItem(label, keys, selected);
  tellControl(label, selected);
  ::ImGui::EndDisabled();
  return pressed;
}
inline bool Checkbox(const char* label, bool* on) {
  const bool pressed = ::ImGui::Checkbox(label, on);
  tellControl(label, *on);
  return pressed;
}
inline bool RadioButton(const char* label, bool on) {
  const bool pressed = ::ImGui::RadioButton(label, on);
  tellControl(label, on);
  return pressed;
}
inline bool CollapsingHeader(const char* label) {
  const bool open = ::ImGui::CollapsingHeader(label);
  tellControl(label, open);
  return open;
}
template <class... Format>
bool TreeNodeEx(const char* label, ImGuiTreeNodeFlags flags, Format... format) {
  const bool open = ::ImGui::TreeNodeEx(label, flags, format...);
  tellControl(label, open);
  return open;
}
inline void TableHeader(const char* label) {
  ::ImGui::TableHeader(label);
  tellControl(label);
}
/// The place of a slider's value: a bar along its lower edge, where a grab would cover the number.
void markSlider(const char* label, ImGuiDataType type, void* value, const void* low, const void* high,
                const char* format, ImGuiSliderFlags flags);
inline bool SliderScalar(const char* label, ImGuiDataType type, void* value, const void* low, const void* high,
                         const char* format = nullptr, ImGuiSliderFlags flags = 0) {
  for (const ImGuiCol color : {ImGuiCol_SliderGrab, ImGuiCol_SliderGrabActive})
    ::ImGui::PushStyleColor(color, IM_COL32_BLACK_TRANS);
  const bool edited = ::ImGui::SliderScalar(label, type, value, low, high, format, flags);
  ::ImGui::PopStyleColor(2);
  markSlider(label, type, value, low, high, format ? format : "%.3f", flags);
  tellControl(label);
  return edited;
}
inline bool SliderFloat(const char* label, float* value, float low, float high, const char* format = "%.3f",
                        ImGuiSliderFlags flags = 0) {
  return SliderScalar(label, ImGuiDataType_Float, value, &low, &high, format, flags);
}
inline bool SliderInt(const char* label, int* value, int low, int high, const char* format = "%d",
                      ImGuiSliderFlags flags = 0) {
  return SliderScalar(label, ImGuiDataType_S32, value, &low, &high, format, flags);
}
#define IRAD_CONTROL(function)                                                           \
  template <class... Arguments>                                                          \
  bool function(const char* label, Arguments&&... arguments) {                           \
    const bool edited = ::ImGui::function(label, std::forward<Arguments>(arguments)...); \
    tellControl(label);                                                                  \
    return edited;                                                                       \
  }
IRAD_CONTROL(ColorButton)
IRAD_CONTROL(ColorEdit3)
IRAD_CONTROL(DragFloat)
IRAD_CONTROL(DragFloat3)
IRAD_CONTROL(DragScalarN)
IRAD_CONTROL(InputInt)
IRAD_CONTROL(InputScalar)
IRAD_CONTROL(InputText)
IRAD_CONTROL(InputTextWithHint)
#undef IRAD_CONTROL
/// A square of saturations and values, and beside it a bar of hues, which have names of their own.
bool ColorPicker(const char* label, glm::vec3& color);

// ---- Controls that open: what they open has their names in front ----

/// ImGui's last item is the one that opened only while it is closed.
inline bool opened(const char* label, bool open) {
  if (open)
    enterControls(label);
  else
    tellControl(label);
  return open;
}
inline bool BeginMenu(const char* label, bool enabled = true) {
  return opened(label, ::ImGui::BeginMenu(label, enabled));
}
inline void EndMenu() {
  leaveControls();
  ::ImGui::EndMenu();
}
inline bool BeginCombo(const char* label, const char* preview, ImGuiComboFlags flags = 0) {
  return opened(label, ::ImGui::BeginCombo(label, preview, flags));
}
inline void EndCombo() {
  leaveControls();
  ::ImGui::EndCombo();
}
inline bool Combo(const char* label, int* chosen, const char* const names[], int count) {
  if (!BeginCombo(label, names[*chosen])) return false;
  bool edited = false;
  for (int i = 0; i < count; ++i)
    if (Selectable(names[i], i == *chosen)) {
      edited = *chosen != i;
      *chosen = i;
    }
  EndCombo();
  return edited;
}
inline bool BeginPopupModal(const char* title, bool* open = nullptr, ImGuiWindowFlags flags = 0) {
  const bool shown = ::ImGui::BeginPopupModal(title, open, flags);
  if (shown) enterControls(title);
  return shown;
}
inline void EndPopupModal() {
  leaveControls();
  ::ImGui::EndPopup();
}
inline bool BeginTabItem(const char* label) {
  const bool shown = ::ImGui::BeginTabItem(label);
  tellControl(label, shown);
  return shown;
}

// ---- IDs ----

inline void PushID(const char* id) {
  ::ImGui::PushID(id);
  enterControls(id);
}
inline void PushID(int id) {
  ::ImGui::PushID(id);
  enterControls(std::to_string(id).c_str());
}
inline void PopID() {
  leaveControls();
  ::ImGui::PopID();
}

}  // namespace irad::ImGui
