#include "ui/widgets.h"

#include <fmt/format.h>
#include <imgui_internal.h>

#include <algorithm>

#include "ui/imgui.h"
#include "ui/session.h"
#include "ui/theme.h"

namespace irad {

void ImGui::markSlider(const char* label, ImGuiDataType type, void* value, const void* low, const void* high,
                       const char* format, ImGuiSliderFlags flags) {
  const ImGuiID id = ImGui::GetItemID();
  if (!ImGui::IsItemVisible() || ImGui::TempInputIsActive(id)) return;
  const ImVec2 from = ImGui::GetItemRectMin(), to = ImGui::GetItemRectMax();
  const float text = ImGui::CalcTextSize(label, nullptr, /*hide_text_after_double_hash=*/true).x;
  const float right = to.x - (text > 0 ? text + ImGui::GetStyle().ItemInnerSpacing.x : 0);
  const ImRect frame(from, {right, to.y});
  ImRect grab;
  constexpr ImGuiID kNobody = 1;  // it only asks where the grab is: no item that the mouse holds has this name
  ImGui::SliderBehavior(frame, kNobody, type, value, low, high, format, flags, &grab);
  const float thick = std::max(0.2f * ImGui::GetFontSize(), 2.0f);
  ImVec4 color = theme::accent;
  color.w = ImGui::GetActiveID() == id ? 1.0f : 0.75f;
  ImGui::GetWindowDrawList()->AddRectFilled({grab.Min.x, to.y - thick}, {grab.Max.x, to.y}, ImGui::GetColorU32(color),
                                            0.5f * thick);
}

bool ImGui::ColorPicker(const char* label, glm::vec3& color) {
  const ImVec2 at = ImGui::GetCursorScreenPos();
  const float bar = ImGui::GetFrameHeight(), gap = ImGui::GetStyle().ItemInnerSpacing.x;
  const float side = std::max(ImGui::CalcItemWidth() - bar - gap, bar);
  const bool edited =
      ImGui::ColorPicker3(label, &color.x,
                          ImGuiColorEditFlags_Float | ImGuiColorEditFlags_NoInputs | ImGuiColorEditFlags_NoSidePreview |
                              ImGuiColorEditFlags_NoLabel | ImGuiColorEditFlags_NoOptions);
  ImGui::enterControls(label);
  ImGui::tellPlace("square", {at.x, at.y}, {at.x + side, at.y + side});
  ImGui::tellPlace("hue", {at.x + side + gap, at.y}, {at.x + side + gap + bar, at.y + side});
  ImGui::leaveControls();
  return edited;
}

void valueRow(const char* label, const std::string& value) {
  const float width = ImGui::GetContentRegionAvail().x;
  ImGui::BeginGroup();  // a tooltip that follows is of the label too
  ImGui::TextColored(theme::dim, "%s",
                     clipped(label, width * kLabelShare - 0.5f * ImGui::GetStyle().ItemSpacing.x).c_str());
  ImGui::SameLine(width * kLabelShare);  // from the group's start
  clippedText(value, width * (1 - kLabelShare));
  ImGui::EndGroup();
  if (Controls::current()) ImGui::tellControl(fmt::format("{}={}", label, value).c_str());
}

namespace {

void showTooltip(std::string_view text) {
  ImGui::PushStyleVar(ImGuiStyleVar_Alpha, 1.0f);  // of what is disabled, too
  ImGui::BeginTooltip();
  ImGui::PushTextWrapPos(ImGui::GetFontSize() * 24);
  ImGui::TextUnformatted(text.data(), text.data() + text.size());
  ImGui::PopTextWrapPos();
  ImGui::EndTooltip();
  ImGui::PopStyleVar();
}

bool itemPointedAt() {
  return ImGui::IsItemHovered(ImGuiHoveredFlags_AllowWhenDisabled);
}

}  // namespace

bool wantsHelp() {
  return itemPointedAt() || Controls::current();
}

void helpTooltip(std::string_view text) {
  const ImVec2 low = ImGui::GetItemRectMin(), high = ImGui::GetItemRectMax();
  if (Controls* controls = Controls::current()) controls->help(text, {low.x, low.y}, {high.x, high.y});
  if (itemPointedAt()) showTooltip(text);
}

void fieldLabel(const char* label, std::string_view help) {
  const float start = ImGui::GetCursorPosX();
  const float width = ImGui::GetContentRegionAvail().x;
  const ImVec2 low = ImGui::GetCursorScreenPos(), high{low.x + width, low.y + ImGui::GetFrameHeight()};
  ImGui::AlignTextToFramePadding();
  clippedText(label, width * kLabelShare);
  if (Controls* controls = Controls::current()) controls->help(help, {low.x, low.y}, {high.x, high.y});
  if (ImGui::IsWindowHovered() && ImGui::IsMouseHoveringRect(low, high) && !ImGui::IsAnyItemActive()) showTooltip(help);
  ImGui::SameLine(start + width * kLabelShare);
  ImGui::SetNextItemWidth(width * (1 - kLabelShare));
}

bool closePopup(int dialogs) {
  if (ImGui::GetCurrentContext()->OpenPopupStack.Size <= dialogs) return false;
  ImGui::ClosePopupToLevel(dialogs, /*restore_focus_to_window_under_popup=*/true);
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
  constexpr const char* kEllipsis = "\u2026";
  const float room = std::max(width - ImGui::CalcTextSize(kEllipsis).x, 0.0f);
  const char *begin = text.c_str(), *end = begin;  // of what has room before the ellipsis
  ImGui::GetFont()->CalcTextSizeA(ImGui::GetFontSize(), room, 0, begin, begin + text.size(), &end);
  return std::string(begin, end) + kEllipsis;
}

void clippedText(const std::string& text, float width) {
  const std::string shown = clipped(text, width);
  ImGui::TextUnformatted(shown.c_str());
  if (shown != text && ImGui::IsItemHovered()) showTooltip(text);
}

void rightText(const std::string& text) {
  const float slack = ImGui::GetContentRegionAvail().x - ImGui::CalcTextSize(text.c_str()).x;
  if (slack > 0) ImGui::SetCursorPosX(ImGui::GetCursorPosX() + slack);
  ImGui::TextUnformatted(text.c_str());
}

bool beginNumberTable(const char* id, const std::vector<TableColumn>& columns) {
  // Where words would be left less than can be read, the table is wider than its region, and scrolls.
  const float number = ImGui::CalcTextSize("00000.0").x, word = 7 * ImGui::GetFontSize();
  const auto least = [&](const TableColumn& c) {
    return c.words ? word : std::max(number, ImGui::CalcTextSize(c.title).x);
  };
  float all = 2 * static_cast<float>(columns.size()) * ImGui::GetStyle().CellPadding.x;
  for (const TableColumn& column : columns) all += least(column);
  const bool narrow = all > ImGui::GetContentRegionAvail().x;
  if (!ImGui::BeginTable(id, static_cast<int>(columns.size()),
                         ImGuiTableFlags_RowBg | ImGuiTableFlags_ScrollY | (narrow ? ImGuiTableFlags_ScrollX : 0),
                         ImGui::GetContentRegionAvail()))
    return false;
  ImGui::TableSetupScrollFreeze(0, 1);
  for (const TableColumn& column : columns) {
    const bool stretches = column.words && !narrow;
    ImGui::TableSetupColumn(column.title,
                            stretches ? ImGuiTableColumnFlags_WidthStretch : ImGuiTableColumnFlags_WidthFixed,
                            stretches ? 1.0f : least(column));
  }
  ImGui::TableNextRow(ImGuiTableRowFlags_Headers);
  ImGui::PushStyleColor(ImGuiCol_Text, theme::dim);
  for (const TableColumn& column : columns) {
    ImGui::TableNextColumn();
    if (column.words)
      ImGui::TextUnformatted(clipped(column.title, ImGui::GetContentRegionAvail().x).c_str());
    else
      rightText(column.title);
    ImGui::PushStyleColor(ImGuiCol_Text, theme::text);
    helpTooltip(column.help);
    ImGui::PopStyleColor();
  }
  ImGui::PopStyleColor();
  return true;
}

bool Refresh::due(const Session& session) {
  const bool resting = session.asleep() && !session.viewDirty && !session.work;
  const bool comesToRest = resting && !rested_;
  rested_ = resting;
  const double now = ImGui::GetTime();
  ++frames_;
  if (last_ >= 0 && !comesToRest && (now - last_ < 0.25 || frames_ < 8)) return false;
  last_ = now;
  frames_ = 0;
  return true;
}

}  // namespace irad
