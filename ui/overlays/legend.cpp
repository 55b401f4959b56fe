// The colours of a view with a range: name, unit, map, ticks, and what is marked instead.
#include <fmt/format.h>

#include <algorithm>

#include "gi/legend.h"
#include "shaders/shared/color_map.h"
#include "ui/color_bar.h"
#include "ui/imgui.h"
#include "ui/theme.h"
#include "ui/viewport.h"
#include "ui/widgets.h"

namespace irad {
namespace {

class LegendOverlay : public Overlay {
 public:
  bool draw(Session& session, const Picture& picture, const PictureMouse&) override {
    const ViewInfo* info = viewInfo(session.view);
    const bool difference = session.showsDifference();
    if (info == nullptr || !(info->hasRange() || difference) || !session.range || session.rangeView != session.view ||
        session.rangeOfDifference != difference)
      return false;
    const Settings& settings = session.pipeline->settings();
    const Quantity quantity = difference ? differenceQuantity(*info, settings) : shownQuantity(*info, settings);
    const ColorMap map = difference ? COLOR_MAP_BLUE_RED : colorMapOf(*info, settings);

    const float em = ImGui::GetFontSize(), line = ImGui::GetTextLineHeightWithSpacing(), margin = em;
    const Rect& where = picture.rect();
    const float width = std::min(20 * em, where.size.x - 4 * margin);
    if (width < 8 * em) return false;  // no room for anything legible
    const Legend legend = makeLegend(quantity, map, *session.range);
    const float height = 2 * line + 1.4f * em + (legend.marks.empty() ? 0 : line);
    const glm::vec2 corner = where.position + where.size - glm::vec2(width, height) - 2 * margin;

    ImDrawList& list = *ImGui::GetWindowDrawList();
    const ImVec2 low{corner.x, corner.y};
    const ImVec2 high{corner.x + width + margin, corner.y + height + margin};
    list.AddRectFilled(low, high, IM_COL32(20, 20, 22, 215), 0.3f * em);
    const glm::vec2 inside = corner + 0.5f * margin;
    const float text = inside.y + line;
    list.PushClipRect(low, high, true);
    list.AddText({inside.x, inside.y}, ImGui::GetColorU32(theme::text), legend.title.c_str());
    drawColorBar(list, {inside.x, text}, {width, em}, map);
    const float bar = text + em;
    drawTicks(list, {inside.x, bar}, width, legend);
    if (!legend.marks.empty())
      list.AddText({inside.x, bar + line + 0.3f * em}, ImGui::GetColorU32(theme::warning), legend.marks.c_str());
    list.PopClipRect();
    return false;
  }

 private:
  static void drawTicks(ImDrawList& list, glm::vec2 at, float width, const Legend& legend) {
    const ImU32 color = ImGui::GetColorU32(theme::text);
    const float em = ImGui::GetFontSize();
    for (const Legend::Tick& tick : legend.ticks) {
      const float x = at.x + width * tick.at;
      list.AddLine({x, at.y}, {x, at.y + 0.3f * em}, color);
      const float half = 0.5f * ImGui::CalcTextSize(tick.label.c_str()).x;
      const float centre = std::clamp(x, at.x + half, at.x + width - half);
      list.AddText({centre - half, at.y + 0.3f * em}, color, tick.label.c_str());
    }
  }
};

}  // namespace

std::unique_ptr<Overlay> makeLegendOverlay() {
  return std::make_unique<LegendOverlay>();
}

}  // namespace irad
