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
bool drawHeader(const char* title, std::set<std::string>& folded) {
  pushHeadingFont();
  ImGui::SetNextItemOpen(!folded.contains(title));
  const bool open = ImGui::CollapsingHeader(title);
  ImGui::PopFont();
  keepFolded(folded, title, open);
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
    beginTile(tile.name, tile.where);
    for (const auto& panel : panels) {
      if (panel->region() != tile.region) continue;
      // The strip is low: its table begins at once.
      if (tile.region != Region::Bottom && !drawHeader(panel->title(), session.preferences.folded)) continue;
      ImGui::PushID(panel->title());
      panel->draw(session);
      ImGui::PopID();
    }
    endTile();
  }
}

}  // namespace irad
