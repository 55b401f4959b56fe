#include "ui/widgets.h"

#include <fmt/format.h>
#include <imgui_internal.h>

#include <algorithm>

#include "ui/imgui.h"
#include "ui/session.h"
#include "ui/theme.h"

namespace irad {

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

bool closePopup() {
  if (ImGui::GetCurrentContext()->OpenPopupStack.empty()) return false;
  ImGui::ClosePopupToLevel(0, /*restore_focus_to_window_under_popup=*/true);
  return true;
}

void keepFolded(std::set<std::string>& folded, const std::string& title, bool open) {
  if (open)
    folded.erase(title);
  else
    folded.insert(title);
}

std::string clipped(const std::string& text, float width) {
  if (ImGui::CalcTextSize(text.c_str()).x <= width) return text;
  std::string cut = text;
  while (!cut.empty() && ImGui::CalcTextSize((cut + "\u2026").c_str()).x > width) {
    // Drop one code point: its continuation bytes, then its first.
    while (!cut.empty() && (static_cast<unsigned char>(cut.back()) & 0xC0) == 0x80) cut.pop_back();
    if (!cut.empty()) cut.pop_back();
  }
  return cut + "\u2026";
}

void clippedText(const std::string& text, float width) {
  const std::string shown = clipped(text, width);
  ImGui::TextUnformatted(shown.c_str());
  if (shown != text) helpTooltip(text);
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

}  // namespace irad
