// Why a picture of light is black all over: in its middle, in words.

#include <algorithm>

#include "ui/imgui.h"
#include "ui/theme.h"
#include "ui/viewport.h"

namespace irad {
namespace {

class NoLightOverlay : public Overlay {
 public:
  bool draw(Session& session, const Picture& picture, const PictureMouse&) override {
    const ViewInfo* info = viewInfo(session.view);
    if (info == nullptr || !info->toneMapped() || info->isFrom(FROM_PICTURE)) return false;
    for (const Side* side : session.sides())
      if (!side->built || side->built->noLight.empty()) return false;

    const float line = ImGui::GetTextLineHeightWithSpacing(), margin = ImGui::GetFontSize();
    const char* const title = "No light";
    const char* const remedy = "The panels Lights and Effects change that.";
    const std::vector<std::string>& lines = session.built->noLight;
    pushHeadingFont();
    float width = ImGui::CalcTextSize(title).x;
    ImGui::PopFont();
    for (const std::string& text : lines) width = std::max(width, ImGui::CalcTextSize(text.c_str()).x);
    width = std::max(width, ImGui::CalcTextSize(remedy).x) + 2 * margin;
    const float height = static_cast<float>(lines.size() + 2) * line + 2 * margin;
    const Rect& where = picture.rect();
    const glm::vec2 corner = where.position + glm::floor(0.5f * (where.size - glm::vec2(width, height)));

    ImDrawList& list = *ImGui::GetWindowDrawList();
    list.AddRectFilled({corner.x, corner.y}, {corner.x + width, corner.y + height},
                       ImGui::GetColorU32(ImGuiCol_PopupBg), 0.3f * margin);
    glm::vec2 at = corner + margin;
    const auto write = [&](const char* text, const ImVec4& color) {
      list.AddText({at.x, at.y}, ImGui::GetColorU32(color), text);
      at.y += line;
    };
    pushHeadingFont();
    write(title, theme::text);
    ImGui::PopFont();
    for (const std::string& text : lines) write(text.c_str(), theme::text);
    write(remedy, theme::dim);
    return false;
  }
};

}  // namespace

std::unique_ptr<Overlay> makeNoLightOverlay() {
  return std::make_unique<NoLightOverlay>();
}

}  // namespace irad
