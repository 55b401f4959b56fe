#include "ui/layout.h"

#include <algorithm>
#include <cmath>

#include "ui/imgui.h"
#include "ui/overlay.h"

namespace irad {
namespace {

constexpr float kNarrowest = 180, kLowest = 110;  ///< panels, units
constexpr float kGrip = 6;                        ///< width of an edge that can be dragged, units

}  // namespace

Layout layout(glm::uvec2 window, float scale, bool hidden, const PanelSizes& sizes) {
  const glm::vec2 size(window);
  Layout l;
  if (hidden) {
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
  const float left = extent(sizes.left, kNarrowest, size.x, 0.26f, 300, 400);
  const float right = extent(sizes.right, kNarrowest, size.x, 0.22f, 260, 340);
  const float bottom = extent(sizes.bottom, kLowest, size.y, 0.26f, 170, 320);
  const float middle = size.x - left - right;
  l.bar = {{0, 0}, {size.x, bar}};
  l.left = {{0, bar}, {left, size.y - bar}};
  l.right = {{size.x - right, bar}, {right, size.y - bar}};
  l.bottom = {{left, size.y - bottom}, {middle, bottom}};
  l.viewport = {{left, bar}, {middle, size.y - bar - bottom}};
  return l;
}

void dragEdges(const Layout& layout, float scale, PanelSizes& sizes) {
  const float grip = std::floor(kGrip * scale);
  struct Edge {
    const char* name;
    Rect where;
    bool upright;
    float* size;
    float now, towards;  ///< pixels; +1: the panel grows with the mouse's coordinate
  };
  const Rect &l = layout.left, &r = layout.right, &b = layout.bottom;
  const Edge edges[] = {
      {"##edge-left", {{l.size.x - grip / 2, l.position.y}, {grip, l.size.y}}, true, &sizes.left, l.size.x, 1},
      {"##edge-right", {{r.position.x - grip / 2, r.position.y}, {grip, r.size.y}}, true, &sizes.right, r.size.x, -1},
      {"##edge-bottom",
       {{b.position.x, b.position.y - grip / 2}, {b.size.x, grip}},
       false,
       &sizes.bottom,
       b.size.y,
       -1},
  };
  for (const Edge& edge : edges) {
    if (edge.where.size.x < 1 || edge.where.size.y < 1) continue;
    ImGui::PushStyleVar(ImGuiStyleVar_WindowPadding, ImVec2(0, 0));
    ImGui::PushStyleVar(ImGuiStyleVar_WindowBorderSize, 0.0f);
    ImGui::PushStyleVar(ImGuiStyleVar_WindowMinSize, ImVec2(1, 1));
    beginTile(edge.name, edge.where, /*filled=*/false, /*scrolls=*/false);
    ImGui::PopStyleVar(3);
    ImGui::InvisibleButton(edge.name, {edge.where.size.x, edge.where.size.y});
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
