// A/B: two sets of settings side by side, what differs between them, and by how much the pictures do.
#include <fmt/format.h>

#include <cmath>

#include "ui/comparison.h"
#include "ui/imgui.h"
#include "ui/metric_rows.h"
#include "ui/panel.h"
#include "ui/setting_rows.h"
#include "ui/theme.h"
#include "ui/widgets.h"
#include "ui/words.h"

namespace irad {
namespace {

class ComparePanel : public Panel {
 public:
  const char* title() const override { return "Compare"; }
  const char* help() const override {
    return "Two sets of settings, A and B, of one scene beside each other, and how far their pictures are apart";
  }
  Region region() const override { return Region::Right; }

  void draw(Session& session) override {
    if (!session.comparison) {
      if (ImGui::Button("Compare with these settings", {-1, 0})) session.compare = true;
      helpTooltip(
          "The present settings become A; a second pipeline of the same scene is B, and edited from then on. It "
          "needs as much memory again.");
      return;
    }
    drawSides(session);
    drawDifferences(session);
    drawResult(*session.comparison, session.view);
    const float half = (ImGui::GetContentRegionAvail().x - ImGui::GetStyle().ItemSpacing.x) / 2;
    savePresetButton("Save A\u2026", half, nameA_, session, session.sideA().edited);
    ImGui::SameLine();
    savePresetButton("Save B\u2026", half, nameB_, session, session.sideB().edited);
    if (ImGui::Button("End the comparison", {-1, 0})) session.leave({Leaving::What::EndComparison});
    helpTooltip("The side that is edited stays; the other one's settings are lost unless they were saved");
  }

 private:
  std::string nameA_, nameB_;  ///< of presets, being typed

  static void drawSides(Session& session) {
    Comparison& comparison = *session.comparison;
    const auto choice = [](const char* label, bool chosen, const char* help) {
      ImGui::SameLine();
      const bool pressed = ImGui::RadioButton(label, chosen);
      helpTooltip(help);
      return pressed;
    };
    ImGui::AlignTextToFramePadding();
    ImGui::TextColored(theme::dim, "edit");
    const char* edit = "The side whose settings the panels show and change; a click in the picture takes its side, too";
    if (choice("A###edit A", !comparison.editsB, edit) && comparison.editsB) session.swapSides();
    if (choice("B###edit B", session.comparison->editsB, edit) && !session.comparison->editsB) session.swapSides();
    ImGui::AlignTextToFramePadding();
    ImGui::TextColored(theme::dim, "show");
    using Show = Comparison::Show;
    struct Entry {
      Show show;
      const char *label, *help;
    };
    for (const auto& [show, label, help] :
         {Entry{Show::Split, "both###show both", "A on the left, B on the right of a line that is dragged"},
          Entry{Show::A, "A###show A", "A alone (X: the other one)"},
          Entry{Show::B, "B###show B", "B alone (X: the other one)"},
          Entry{Show::Difference, "B \u2212 A###show B - A",
                "The view's values of B less those of A, in its unit: blue below 0, red above"}})
      if (choice(label, comparison.show == show, help)) {
        comparison.show = show;
        session.viewDirty = true;
      }
    ImGui::Checkbox("same seed", &comparison.sameSeed);
    helpTooltip(
        "Both sides trace the same random rays (matrix.seed of the edited one), so that what differs comes from the "
        "settings. Off: each its own, which shows the noise of the rays.");
    const float half = (ImGui::GetContentRegionAvail().x - ImGui::GetStyle().ItemSpacing.x) / 2;
    if (ImGui::Button(fmt::format("Copy A {} B###copy A to B", arrowGlyph()).c_str(), {half, 0}))
      copy(session, /*toB=*/true);
    helpTooltip("B gets all settings of A");
    ImGui::SameLine();
    if (ImGui::Button(fmt::format("Copy B {} A###copy B to A", arrowGlyph()).c_str(), {half, 0}))
      copy(session, /*toB=*/false);
    helpTooltip("A gets all settings of B");
  }

  static void copy(Session& session, bool toB) {
    (toB ? session.sideB() : session.sideA()).edited = (toB ? session.sideA() : session.sideB()).edited;
  }

  static void drawDifferences(Session& session) {
    if (!differenceTable("differences", session.sideA().edited, session.sideB().edited, "A", "B"))
      ImGui::TextColored(theme::dim, "the same settings");
  }

  static void drawResult(Comparison& comparison, View view) {
    if (!comparison.result) {
      ImGui::TextColored(theme::dim, "Numbers follow once both sides are solved.");
      return;
    }
    const Comparison::Result result = *comparison.result;
    const char* unit = "";
    for (const ViewInfo& info : views())
      if (info.view == view) unit = info.unit;
    if (!ImGui::BeginTable("result", 3, ImGuiTableFlags_RowBg | ImGuiTableFlags_SizingStretchProp)) return;
    ImGui::TableSetupColumn("B against A", 0, 1.3f);
    ImGui::TableSetupColumn("picture", 0, 1);
    ImGui::TableSetupColumn("H of voxels", 0, 1);
    ImGui::TableHeadersRow();
    const auto row = [](const char* name, const std::string& picture, const std::string& voxels,
                        const std::string& help) {
      ImGui::TableNextColumn();
      ImGui::TextColored(theme::dim, "%s", name);
      helpTooltip(help);
      ImGui::TableNextColumn();
      const ImVec2 at = ImGui::GetCursorScreenPos();
      if (Controls::current())
        ImGui::tellPlace(fmt::format("result/{}", name).c_str(), {at.x, at.y},
                         {at.x + ImGui::GetContentRegionAvail().x, at.y + ImGui::GetTextLineHeight()});
      rightText(picture);
      ImGui::TableNextColumn();
      rightText(voxels);
    };
    const std::vector<MetricRow> picture = metricRows(result.picture, "B", "A", prettyUnit(unit)),
                                 voxels = metricRows(result.voxels.irradiance, "B", "A", "W/m\u00B2");
    for (size_t i = 0; i < picture.size(); ++i)
      row(picture[i].name, picture[i].text, voxels[i].text, picture[i].help + (*unit ? " Voxels: in W/m\u00B2." : ""));
    const Metrics &p = result.picture.pixels, &v = result.voxels.irradiance;
    row("compared", withThousands(p.elements), withThousands(v.elements),
        fmt::format(
            "Pixels, and voxels that are solid on both sides; {} only in A, {} only in B; left out for what is no "
            "number: {}, {}",
            withThousands(result.voxels.onlyReference), withThousands(result.voxels.onlyValues),
            counted(p.leftOut, "pixel"), counted(v.leftOut, "voxel")));
    ImGui::EndTable();
    if (std::isfinite(result.picture.flip)) return;
    if (ImGui::Button("FLIP", {-1, 0})) {
      comparison.wantFlip = true;
      comparison.result.reset();
    }
    helpTooltip(
        "Measures how different the two pictures look to the eye, 0 (the same) to 1. Takes a moment: they are filtered "
        "as the eye does.");
  }
};

}  // namespace

std::unique_ptr<Panel> makeComparePanel() {
  return std::make_unique<ComparePanel>();
}

}  // namespace irad
