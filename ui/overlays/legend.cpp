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
    if (info && info->kind == VIEW_KIND_SITE && !difference && session.built) drawSites(session, picture);
    if (info == nullptr || !(info->hasRange() || difference) || !session.range || session.rangeView != session.view ||
        session.rangeOfDifference != difference)
      return false;
    const Settings& settings = session.pipeline->settings();
    const Quantity quantity = difference ? differenceQuantity(*info, settings) : shownQuantity(*info, settings);
    const ColorMap map = difference ? COLOR_MAP_BLUE_RED : colorMapOf(*info, settings);

    const float em = ImGui::GetFontSize(), line = ImGui::GetTextLineHeightWithSpacing();
    const Legend legend = makeLegend(quantity, map, *session.range);
    const auto box = drawBox(session, picture, 2 * line + 1.4f * em + (legend.marks.empty() ? 0 : line));
    if (!box) return false;
    const float width = box->size.x;
    ImDrawList& list = *ImGui::GetWindowDrawList();
    const glm::vec2 inside = box->position, low = inside - 0.5f * em, high = inside + box->size + 0.5f * em;
    const float text = inside.y + line;
    list.PushClipRect({low.x, low.y}, {high.x, high.y}, true);
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
  /// In the lower right corner, so high inside. What is inside; none where there is no room for anything legible.
  static std::optional<Rect> drawBox(Session& session, const Picture& picture, float height) {
    const float em = ImGui::GetFontSize(), margin = em;
    const Rect where = picture.clear();
    float width = std::min(20 * em, where.size.x - 4 * margin);
    if (width < 8 * em) return std::nullopt;
    for (const Rect& other : session.legends) {  // beside one on the left where that leaves enough for the ticks
      const float room = where.position.x + where.size.x - 2.5f * margin - other.position.x - other.size.x;
      if (room >= 12 * em) width = std::min(width, room);
    }
    const glm::vec2 size(width, height);
    glm::vec2 corner = where.position + where.size - size - 2 * margin;
    for (const Rect& other : session.legends)  // above one that reaches as far to the right
      if (corner.x < other.position.x + other.size.x + 0.5f * margin)
        corner.y = std::min(corner.y, other.position.y - size.y - 1.5f * margin);
    const glm::vec2 high = corner + size + margin;
    ImGui::GetWindowDrawList()->AddRectFilled({corner.x, corner.y}, {high.x, high.y}, IM_COL32(20, 20, 22, 215),
                                              0.3f * em);
    session.legends.push_back({corner, size + margin});
    ImGui::tellPlace("legend", corner, high);
    return Rect{corner + 0.5f * margin, size};
  }

  /// Of colours that are places: a bar along each axis of the grid, as the view paints voxels there on the average.
  static void drawSites(Session& session, const Picture& picture) {
    const glm::uvec3 dims = session.built->dims;
    const float em = ImGui::GetFontSize(), line = ImGui::GetTextLineHeightWithSpacing(), letter = 1.2f * em;
    const auto box = drawBox(session, picture, 5 * line);
    if (!box) return;
    const float width = box->size.x;
    ImDrawList& list = *ImGui::GetWindowDrawList();
    glm::vec2 at = box->position;
    const auto say = [&](glm::vec2 place, const std::string& text, bool right = false) {
      if (right) place.x -= ImGui::CalcTextSize(text.c_str()).x;
      list.AddText({place.x, place.y}, ImGui::GetColorU32(theme::text), text.c_str());
    };
    say(at, "Place of the nearest seed (voxels)");
    at.y += line;
    const float numbers = ImGui::CalcTextSize("0000").x, bar = width - letter - numbers;
    for (int axis = 0; axis < 3; ++axis, at.y += line) {
      say(at, std::string(1, static_cast<char>('x' + axis)));
      glm::vec3 from(0.15f + 0.5f * 0.85f), to = from;
      from[axis] = 0.15f, to[axis] = 1;
      const auto color = [](const glm::vec3& c) {
        return ImGui::ColorConvertFloat4ToU32({0.83f * c.x, 0.83f * c.y, 0.83f * c.z, 1});
      };
      list.AddRectFilledMultiColor({at.x + letter, at.y}, {at.x + letter + bar, at.y + em}, color(from), color(to),
                                   color(to), color(from));
      say({at.x + width, at.y}, fmt::format("{}", dims[static_cast<size_t>(axis)] - 1), /*right=*/true);
    }
    say(at, "grey: none yet; brightness by voxel");
  }

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
