#include "ui/panel.h"

#include "ui/imgui.h"
#include "ui/menu.h"
#include "ui/overlay.h"
#include "ui/theme.h"
#include "ui/widgets.h"

namespace irad {

Panels makePanels() {
  Panels panels;
#define IRAD_MAKE_PANEL(name) panels.push_back(make##name##Panel());
  IRAD_PANELS(IRAD_MAKE_PANEL)
#undef IRAD_MAKE_PANEL
  return panels;
}

namespace {

/// True while the panel is unfolded.
bool drawHeader(const Panel& panel, std::set<std::string>& folded) {
  pushHeadingFont();
  ImGui::SetNextItemOpen(!folded.contains(panel.title()));
  const bool open = ImGui::CollapsingHeader(panel.title());
  ImGui::PopFont();
  helpTooltip(panel.help());
  keepFolded(folded, panel.title(), open);
  return open;
}

}  // namespace

void drawPanels(Session& session, const Panels& panels, const Layout& layout) {
  drawMenuBar(session, panels, layout.bar);
  struct Tile {
    Region region;
    const char* name;
    Rect where;
  };
  const Tile tiles[] = {{Region::Left, "##left", layout.left},
                        {Region::Right, "##right", layout.right},
                        {Region::Bottom, "##bottom", layout.bottom}};
  for (const Tile& tile : tiles) {
    if (tile.where.size.x < 1 || tile.where.size.y < 1) continue;  // folded to the edge
    const bool strip = tile.region == Region::Bottom;
    // Folded, the strip is no more than its header.
    if (strip) ImGui::PushStyleVar(ImGuiStyleVar_WindowPadding, ImVec2(ImGui::GetStyle().WindowPadding.x, 3));
    beginTile(tile.name, tile.where, /*filled=*/false, /*scrolls=*/!strip);
    if (strip) ImGui::PopStyleVar();
    for (const auto& panel : panels) {
      if (panel->region() != tile.region) continue;
      const bool open = drawHeader(*panel, session.preferences.folded);
      // Beside its title, where there is room for both.
      if (const std::string time = frameTime(session) + "  ";
          strip && !open && ImGui::CalcTextSize(time.c_str()).x < 0.45f * tile.where.size.x) {
        ImGui::SameLine(ImGui::GetWindowWidth() * 0.5f);
        ImGui::PushStyleColor(ImGuiCol_Text, theme::dim);
        rightText(time);
        ImGui::PopStyleColor();
      }
      if (!open) continue;
      ImGui::PushID(panel->title());
      panel->draw(session);
      ImGui::PopID();
    }
    endTile();
  }
}

}  // namespace irad
