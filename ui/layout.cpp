#include "ui/layout.h"

#include <algorithm>
#include <cmath>

#include "ui/imgui.h"
#include "ui/overlay.h"
#include "ui/theme.h"
#include "ui/widgets.h"

namespace irad {
namespace {

constexpr float kNarrowest = 180, kLowest = 110;  ///< panels, units
constexpr float kGrip = 6;                        ///< width of an edge that can be dragged, units
constexpr float kHeader = 28;                     ///< height of the folded strip, units
constexpr glm::vec2 kHandle{12, 44};              ///< of a column, units

}  // namespace

Layout layout(glm::uvec2 window, float scale, Filling filling, const PanelSizes& sizes, const Folding& folding) {
  const glm::vec2 size(window);
  Layout l;
  if (filling == Filling::PictureAlone) {
    l.viewport = {{0, 0}, size};
    return l;
  }
  // The user's size, else a share of the window within readable bounds; never more than a third.
  const auto extent = [&](float wanted, float least, float whole, float share, float low, float high) {
    const float chosen =
        wanted > 0 ? std::max(wanted, least) * scale : std::clamp(whole * share, low * scale, high * scale);
    return std::floor(std::min(chosen, whole * (wanted > 0 ? 0.4f : 1.0f / 3.0f)));
  };
  const float bar = std::min(std::floor(30.0f * scale), size.y / 3.0f);
  l.bar = {{0, 0}, {size.x, bar}};
  if (filling == Filling::Picture) {
    l.viewport = {{0, bar}, {size.x, size.y - bar}};
    return l;
  }
  const float left = folding.left ? 0 : extent(sizes.left, kNarrowest, size.x, 0.234f, 300, 400);
  const float right = folding.right ? 0 : extent(sizes.right, kNarrowest, size.x, 0.203f, 260, 340);
  const float bottom = folding.strip ? std::floor(std::min(kHeader * scale, size.y / 3.0f))
                                     : extent(sizes.bottom, kLowest, size.y, 0.28f, 190, 340);
  const float middle = size.x - left - right;
  l.left = {{0, bar}, {left, size.y - bar}};
  l.right = {{size.x - right, bar}, {right, size.y - bar}};
  l.bottom = {{left, size.y - bottom}, {middle, bottom}};
  l.viewport = {{left, bar}, {middle, size.y - bar - bottom}};
  return l;
}

namespace {

/// A tile of nothing but a button, over the others; true: it is there, end it with endTile().
bool beginButton(const char* name, const Rect& where) {
  if (where.size.x < 1 || where.size.y < 1) return false;
  ImGui::PushStyleVar(ImGuiStyleVar_WindowPadding, ImVec2(0, 0));
  ImGui::PushStyleVar(ImGuiStyleVar_WindowBorderSize, 0.0f);
  ImGui::PushStyleVar(ImGuiStyleVar_WindowMinSize, ImVec2(1, 1));
  beginTile(name, where, /*filled=*/false, /*scrolls=*/false);
  ImGui::PopStyleVar(3);
  ImGui::InvisibleButton(name, {where.size.x, where.size.y});
  return true;
}

/// On the picture's side of the column's edge, in the middle of its height.
void drawHandle(const char* name, const Rect& viewport, float scale, bool onLeft, std::set<std::string>& folded) {
  const glm::vec2 size = glm::floor(kHandle * scale);
  if (viewport.size.y < 3 * size.y || viewport.size.x < 6 * size.x) return;
  const char* column = onLeft ? kLeftColumn : kRightColumn;
  const bool isFolded = folded.contains(column);
  const float inset = isFolded ? 0 : std::floor(kGrip * scale / 2);  // the column's edge can be dragged all along
  const glm::vec2 at{onLeft ? viewport.position.x + inset : viewport.position.x + viewport.size.x - size.x - inset,
                     std::floor(viewport.position.y + 0.5f * (viewport.size.y - size.y))};
  if (!beginButton(name, {at, size})) return;
  if (ImGui::IsItemClicked()) keepFolded(folded, column, isFolded);
  const bool lit = ImGui::IsItemHovered();
  ImDrawList& list = *ImGui::GetWindowDrawList();
  list.AddRectFilled({at.x, at.y}, {at.x + size.x, at.y + size.y}, IM_COL32(20, 20, 22, lit ? 240 : 150), 3 * scale,
                     onLeft ? ImDrawFlags_RoundCornersRight : ImDrawFlags_RoundCornersLeft);
  // An arrow to where the column goes, or comes from.
  const float arm = 3.0f * scale, towards = (onLeft == isFolded) ? arm : -arm;
  const glm::vec2 middle = at + 0.5f * size;
  const ImU32 color = ImGui::GetColorU32(lit ? theme::accent : theme::text);
  list.AddTriangleFilled({middle.x + towards, middle.y}, {middle.x - towards, middle.y - 1.6f * arm},
                         {middle.x - towards, middle.y + 1.6f * arm}, color);
  helpTooltip(isFolded ? "Bring this column back" : "Fold this column to the edge (Tab: all panels)");
  endTile();
}

}  // namespace

void drawEdges(const Layout& layout, float scale, PanelSizes& sizes, std::set<std::string>& folded) {
  // Drawn first, they lie above the edges.
  drawHandle("##fold-left", layout.viewport, scale, /*onLeft=*/true, folded);
  drawHandle("##fold-right", layout.viewport, scale, /*onLeft=*/false, folded);
  const float grip = std::floor(kGrip * scale);
  struct Edge {
    const char* name;
    Rect where;
    bool upright;
    float* size;
    float now, towards;  ///< pixels; +1: the panel grows with the mouse's coordinate
    bool there;
  };
  const Rect &l = layout.left, &r = layout.right, &b = layout.bottom;
  const Edge edges[] = {
      {"##edge-left",
       {{l.size.x - grip / 2, l.position.y}, {grip, l.size.y}},
       true,
       &sizes.left,
       l.size.x,
       1,
       l.size.x > 0},
      {"##edge-right",
       {{r.position.x - grip / 2, r.position.y}, {grip, r.size.y}},
       true,
       &sizes.right,
       r.size.x,
       -1,
       r.size.x > 0},
      {"##edge-bottom",
       {{b.position.x, b.position.y - grip / 2}, {b.size.x, grip}},
       false,
       &sizes.bottom,
       b.size.y,
       -1,
       b.size.y > std::floor(kHeader * scale)},
  };
  for (const Edge& edge : edges) {
    if (!edge.there || !beginButton(edge.name, edge.where)) continue;
    const ImGuiIO& io = ImGui::GetIO();
    if (ImGui::IsItemHovered() || ImGui::IsItemActive()) {
      ImGui::SetMouseCursor(edge.upright ? ImGuiMouseCursor_ResizeEW : ImGuiMouseCursor_ResizeNS);
      const ImVec2 low = ImGui::GetItemRectMin(), high = ImGui::GetItemRectMax();
      ImGui::GetWindowDrawList()->AddRectFilled(
          low, high, ImGui::GetColorU32(ImGui::IsItemActive() ? ImGuiCol_SeparatorActive : ImGuiCol_SeparatorHovered));
    }
    const float moved = edge.upright ? io.MouseDelta.x : io.MouseDelta.y;
    if (ImGui::IsItemHovered() && ImGui::IsMouseDoubleClicked(ImGuiMouseButton_Left))
      *edge.size = 0;
    else if (ImGui::IsItemActive() && !ImGui::IsItemActivated() && moved != 0)
      *edge.size = std::max((edge.now + edge.towards * moved) / scale, 1.0f);
    endTile();
  }
}

}  // namespace irad
