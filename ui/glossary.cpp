#include "ui/glossary.h"

#include <algorithm>
#include <array>

#include "ui/imgui.h"
#include "ui/session.h"
#include "ui/theme.h"

namespace irad {

std::span<const Term> glossary() {
  static constexpr std::array kTerms{
      Term{"facet", "", "",
           "A piece of surface in one voxel, with a plane, an area and a colour. All light is kept per facet."},
      Term{"D", "direct irradiance", "W/m\u00B2",
           "Light that reaches a facet straight from suns, points and spots, behind no other surface."},
      Term{"H", "indirect irradiance", "W/m\u00B2",
           "Light that reaches a facet from other facets and from the sky: H = F B + S. What is solved for."},
      Term{"B", "radiosity", "W/m\u00B2", "All light that leaves a facet diffusely: B = M + \u03C1 (D + H) + W."},
      Term{"M", "emitted exitance", "W/m\u00B2",
           "Light that a facet gives of itself: \u03C0 times the radiance of its emission."},
      Term{"S", "irradiance from the sky", "W/m\u00B2", "The part of H whose rays have left the scene."},
      Term{"W", "reflections written back", "W/m\u00B2",
           "Mirror-like light that pixels show and hand back to facets; 0 unless writeback.mode says otherwise."},
      Term{
          "F", "form factor", "",
          "The share of the light that reaches one facet which comes from another, counted by rays. A facet's row of F "
          "holds whom it gathers from, its column who gathers from it."},
      Term{"\u03C1", "albedo", "",
           "The share of the light that arrives which a facet reflects diffusely; 0 to 0.98, per colour."},
      Term{"\u03BB", "solver.lambda", "",
           "A factor on all light that facets send on; 1 is physical, less darkens each bounce."},
      Term{"\u03C9", "solver.omega", "", "The share of each sweep's change that is taken over; less than 1 damps."},
      Term{"\u03BA", "error factor", "", "Proven from the rows: an error of B is at most so many times the residual."},
      Term{"row gain", "", "", "The share of its light that a facet's row passes on; below 1 the solver converges."},
      Term{"sweep", "", "", "One round of the solver: every facet gathers once from all of its row."},
      Term{"residual", "", "W/m\u00B2", "The largest change of B that one more sweep would make."},
      Term{"bound", "", "W/m\u00B2",
           "How far B can be from the exact solution at most: (\u03BA/\u03C9 \u2212 1) times the residual. The solver "
           "sleeps below its target."},
      Term{"cd", "candela", "W/sr", "A light's strength in one direction; here 1 cd = 1 W/sr."},
      Term{"lx", "lux", "W/m\u00B2", "Light that arrives on a surface; here 1 lx = 1 W/m\u00B2, and so 1 lm = 1 W."},
      Term{"EV", "exposure", "", "A picture is shown 2^EV times as bright."},
      Term{"relMSE", "relative error", "",
           "How wrong a picture is, squared, as a share of its light: the mean of (value \u2212 reference)\u00B2 / "
           "(reference\u00B2 + (0.1 mean reference)\u00B2) over blocks of 8 \u00D7 8 pixels. 0: none; 0.01: about a "
           "tenth of the light."},
  };
  return kTerms;
}

void drawGlossary(Session& session, const Rect& window) {
  if (!session.showGlossary) return;
  const float em = ImGui::GetFontSize();
  const ImVec2 size{std::max(std::min(54 * em, window.size.x - 2 * em), 8 * em),
                    std::max(window.size.y - 2 * em, 8 * em)};
  ImGui::SetNextWindowPos({window.position.x + 0.5f * window.size.x, window.position.y + 0.5f * window.size.y},
                          ImGuiCond_Always, {0.5f, 0.5f});
  ImGui::SetNextWindowSizeConstraints({size.x, 0}, size);
  ImGui::Begin("##glossary", nullptr,
               ImGuiWindowFlags_NoTitleBar | ImGuiWindowFlags_NoResize | ImGuiWindowFlags_NoCollapse |
                   ImGuiWindowFlags_NoMove | ImGuiWindowFlags_NoSavedSettings | ImGuiWindowFlags_AlwaysAutoResize |
                   ImGuiWindowFlags_NoFocusOnAppearing);
  ImGui::PushID("glossary");
  pushHeadingFont();
  ImGui::TextUnformatted("Glossary");
  ImGui::PopFont();
  ImGui::SameLine(size.x - 6 * em);
  if (ImGui::Button("Close", {4.5f * em, 0})) session.showGlossary = false;
  if (ImGui::BeginTable("terms", 3, ImGuiTableFlags_RowBg)) {
    ImGui::TableSetupColumn("term", ImGuiTableColumnFlags_WidthFixed, 11.5f * em);
    ImGui::TableSetupColumn("unit", ImGuiTableColumnFlags_WidthFixed, 3.5f * em);
    ImGui::TableSetupColumn("meaning", ImGuiTableColumnFlags_WidthStretch);
    for (const Term& term : glossary()) {
      ImGui::TableNextRow();
      ImGui::TableNextColumn();
      ImGui::TextColored(theme::accent, "%s", term.symbol);
      if (*term.name != 0) {
        ImGui::SameLine(0, 0.5f * em);
        ImGui::TextUnformatted(term.name);
      }
      ImGui::TableNextColumn();
      ImGui::TextColored(theme::dim, "%s", term.unit);
      ImGui::TableNextColumn();
      ImGui::PushTextWrapPos(0);
      ImGui::TextUnformatted(term.meaning);
      ImGui::PopTextWrapPos();
    }
    ImGui::EndTable();
  }
  ImGui::PopID();
  ImGui::End();
}

}  // namespace irad
