#include "ui/light_color.h"

#include "ui/theme.h"
#include "ui/widgets.h"

namespace irad {
namespace {

ImVec4 swatch(const glm::vec3& shown) {
  return {shown.x, shown.y, shown.z, 1};
}

/// What the button opens: the picker, the colour as it was, and numbers.
bool drawPicker(glm::vec3& shown) {
  const float box = ImGui::GetFrameHeight(), width = 12 * box;
  // Each popup keeps the colour with which it was opened.
  ImGuiStorage& kept = *ImGui::GetStateStorage();
  const ImGuiID key = ImGui::GetID("first");
  glm::vec3 first;
  for (int c = 0; c < 3; ++c) {
    if (ImGui::IsWindowAppearing()) kept.SetFloat(key + static_cast<ImGuiID>(c), shown[c]);
    first[c] = kept.GetFloat(key + static_cast<ImGuiID>(c));
  }
  ImGui::SetNextItemWidth(width);
  bool edited = ImGui::ColorPicker("##picker", shown);
  ImGui::SameLine();
  ImGui::BeginGroup();
  const ImVec2 large{3 * box, 2 * box};
  ImGui::TextColored(theme::dim, "now");
  ImGui::ColorButton("now", swatch(shown), ImGuiColorEditFlags_Float, large);
  ImGui::TextColored(theme::dim, "before");
  if (ImGui::ColorButton("before", swatch(first), ImGuiColorEditFlags_Float, large)) {
    shown = first;
    edited = true;
  }
  ImGui::EndGroup();
  for (const auto& [label, numbers] : {std::pair("##RGB", ImGuiColorEditFlags_DisplayRGB),
                                       {"##HSV", ImGuiColorEditFlags_DisplayHSV},
                                       {"##hex", ImGuiColorEditFlags_DisplayHex}}) {
    ImGui::SetNextItemWidth(width);
    edited |= ImGui::ColorEdit3(
        label, &shown.x,
        numbers | ImGuiColorEditFlags_Float | ImGuiColorEditFlags_NoSmallPreview | ImGuiColorEditFlags_NoOptions);
  }
  return edited;
}

}  // namespace

bool colorField(const char* id, glm::vec3& linear) {
  const glm::vec3 before = glm::convertLinearToSRGB(linear);
  glm::vec3 shown = before;
  const float box = ImGui::GetFrameHeight(), gap = ImGui::GetStyle().ItemInnerSpacing.x;
  ImGui::SetNextItemWidth(ImGui::CalcItemWidth() - box - gap);
  bool edited = ImGui::ColorEdit3(
      id, &shown.x, ImGuiColorEditFlags_Float | ImGuiColorEditFlags_NoSmallPreview | ImGuiColorEditFlags_NoOptions);
  ImGui::SameLine(0, gap);
  ImGui::PushID(id);
  if (ImGui::ColorButton("pick", swatch(shown), ImGuiColorEditFlags_Float)) ImGui::OpenPopup("picker");
  if (ImGui::BeginPopup("picker")) {
    edited |= drawPicker(shown);
    ImGui::EndPopup();
  }
  ImGui::PopID();
  if (!edited) return false;
  const glm::vec3 taken = glm::clamp(glm::convertSRGBToLinear(shown), 0.0f, 1.0f);
  for (int c = 0; c < 3; ++c)
    if (shown[c] != before[c]) linear[c] = taken[c];
  return true;
}

}  // namespace irad
