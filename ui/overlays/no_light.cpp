// Why a picture of light is black, in words: in its middle where it is so all over, else in a corner.

#include <algorithm>

#include "ui/imgui.h"
#include "ui/theme.h"
#include "ui/viewport.h"

namespace irad {
namespace {

/// What to say, and what would mend it.
struct Notice {
  const char* title;
  std::vector<std::string> lines;
  std::string remedy;
  bool corner;  ///< the lower left one
};

class NoLightOverlay : public Overlay {
 public:
  bool draw(Session& session, const Picture& picture, const PictureMouse&) override {
    const ViewInfo* info = viewInfo(session.view);
    if (info == nullptr || !info->toneMapped() || info->isFrom(FROM_PICTURE)) return false;
    const auto all = [&](const std::vector<std::string> Built::*lines) {
      return std::ranges::all_of(session.sides(),
                                 [&](const Side* side) { return side->built && !((*side->built).*lines).empty(); });
    };
    if (all(&Built::noLight)) {
      write(picture.clear(),
            {"No light", session.built->noLight, "The panels Lights and Effects change that.", /*corner=*/false});
    } else if (all(&Built::nothingDiffuse)) {
      std::vector<std::string> lines = session.built->nothingDiffuse;
      std::string remedy = lines.back();
      lines.pop_back();
      write(picture.clear(), {"Nothing diffuse", std::move(lines), std::move(remedy), /*corner=*/true});
    }
    return false;
  }

 private:
  static void write(const Rect& where, const Notice& notice) {
    const float line = ImGui::GetTextLineHeightWithSpacing(), margin = ImGui::GetFontSize();
    pushHeadingFont();
    float width = ImGui::CalcTextSize(notice.title).x;
    ImGui::PopFont();
    for (const std::string& text : notice.lines) width = std::max(width, ImGui::CalcTextSize(text.c_str()).x);
    width = std::max(width, ImGui::CalcTextSize(notice.remedy.c_str()).x) + 2 * margin;
    const float height = static_cast<float>(notice.lines.size() + 2) * line + 2 * margin;
    const glm::vec2 free = where.size - glm::vec2(width, height);
    const glm::vec2 corner =
        where.position + (notice.corner ? glm::vec2(margin, free.y - margin) : glm::floor(0.5f * free));

    ImDrawList& list = *ImGui::GetWindowDrawList();
    list.AddRectFilled({corner.x, corner.y}, {corner.x + width, corner.y + height},
                       ImGui::GetColorU32(ImGuiCol_PopupBg), 0.3f * margin);
    glm::vec2 at = corner + margin;
    const auto say = [&](const char* text, const ImVec4& color) {
      list.AddText({at.x, at.y}, ImGui::GetColorU32(color), text);
      at.y += line;
    };
    pushHeadingFont();
    say(notice.title, theme::text);
    ImGui::PopFont();
    for (const std::string& text : notice.lines) say(text.c_str(), theme::text);
    say(notice.remedy.c_str(), theme::dim);
  }
};

}  // namespace

std::unique_ptr<Overlay> makeNoLightOverlay() {
  return std::make_unique<NoLightOverlay>();
}

}  // namespace irad
