// The picked facet: its record, its row and column of the matrix, one of its rays step by step.
#include <fmt/format.h>

#include <algorithm>
#include <initializer_list>
#include <utility>

#include "gi/lighting.h"
#include "renderer/base/number_text.h"
#include "shaders/shared/emitters.h"
#include "ui/imgui.h"
#include "ui/link_table.h"
#include "ui/panel.h"
#include "ui/theme.h"
#include "ui/widgets.h"
#include "ui/words.h"

namespace irad {
namespace {

std::string three(const glm::dvec3& v) {
  return fmt::format("{} {} {}", withDigits(v.x), withDigits(v.y), withDigits(v.z));
}
std::string three(const glm::uvec3& v) {
  return fmt::format("{} {} {}", v.x, v.y, v.z);
}
std::string percent(double share) {
  return percentText(share, 1);
}

class InspectorPanel : public Panel {
 public:
  const char* title() const override { return "Inspector"; }
  const char* help() const override {
    return "One facet: its light, which facets it gathers from, which gather from it, and its rays";
  }
  Region region() const override { return Region::Right; }

  void draw(Session& session) override {
    Inspection& in = session.inspection;
    in.highlighted.reset();
    const InspectedFacet* facet = in.facet();
    if (!facet && in.voxel) return drawEmpty(in);
    if (!facet) {
      ImGui::PushTextWrapPos(0);
      ImGui::TextColored(theme::dim,
                         "Click the picture to inspect a voxel; Shift-click another to compare their rows.");
      ImGui::PopTextWrapPos();
      return;
    }
    drawTop(session);
    drawPlace(in, *facet);
    drawNormal(*facet);
    const bool hasMatrix = session.pipeline->obeyed().solver.method == SolverMethod::matrix;
    drawLight(*facet, hasMatrix);
    if (!hasMatrix) {
      valueRow("frames", withThousands(session.pipeline->lighting().report.frames));
      helpTooltip("In the mean of H, each with rays of its own");
    }
    drawHistory(in, hasMatrix);
    if (hasMatrix) {
      drawMatrix(in, *facet);
    } else {
      ImGui::PushTextWrapPos(0);
      ImGui::TextColored(theme::dim,
                         "solver.method = brute_force: there is no matrix, and so neither row nor column. Each frame "
                         "traces this facet's rays anew; below are those of the first.");
      ImGui::PopTextWrapPos();
    }
    drawRay(in, *facet);
  }

 private:
  /// Which of the voxel's facets, back along the trail, and done.
  static void drawTop(Session& session) {
    Inspection& in = session.inspection;
    const ImGuiStyle& style = ImGui::GetStyle();
    for (size_t f = 0; f < in.voxel->facets.size(); ++f) {
      const std::string name = fmt::format("facet {}", in.voxel->facets[f].facet);
      const float width = ImGui::GetFrameHeight() + style.ItemInnerSpacing.x + ImGui::CalcTextSize(name.c_str()).x;
      if (f > 0) ImGui::SameLine();
      if (f > 0 && ImGui::GetContentRegionAvail().x < width) ImGui::NewLine();
      if (ImGui::RadioButton(name.c_str(), in.chosen == f) && in.chosen != f) in.choose = f;
      helpTooltip("The voxel holds several facets, one for each side of a surface in it: the one shown below");
    }
    ImGui::BeginDisabled(in.trail.empty());
    if (ImGui::Button("Back")) in.goBack = true;
    helpTooltip("Back to the facet that a link was followed from");
    ImGui::EndDisabled();
    ImGui::SameLine();
    if (ImGui::Button("Clear")) in.clear = true;
    helpTooltip("Lets go of the voxel (Esc)");
    const Scene& scene = session.pipeline->scene();
    if (!session.material || *session.material >= scene.materials.size()) return;
    ImGui::SameLine();
    if (ImGui::Button("Material")) session.showPanel("Materials", kLeftColumn);
    helpTooltip([&] {
      return fmt::format("Edit \"{}\", of the surface that was clicked, in the panel Materials",
                         scene.materials[*session.material].name);
    });
  }

  /// A voxel of a slice that holds no facet.
  static void drawEmpty(Inspection& in) {
    if (ImGui::Button("Clear")) in.clear = true;
    helpTooltip("Lets go of the voxel (Esc)");
    drawVoxel(in);
    ImGui::TextColored(theme::dim, "An empty voxel: no facet, and so no light of its own.");
  }

  static void drawVoxel(const Inspection& in) {
    valueRow("voxel", three(in.voxel->voxel));
    helpTooltip("Its place in the grid: x y z, from 0");
    const glm::dvec3& world = in.voxel->world;
    valueRow("world", fmt::format("{:.4g} {:.4g} {:.4g}", world.x, world.y, world.z));
    helpTooltip("The voxel's centre: x y z in the world, metres");
    const std::string voxels = fmt::format("{:.3g}", in.voxel->distance);
    valueRow("distance", fmt::format("{:.3g} m, {} {}", in.voxel->distance * in.edge(), voxels,
                                     voxels == "1" ? "voxel" : "voxels"));
    helpTooltip("From here to the nearest solid voxel by the distance field in use, in metres and in voxels");
    if (in.voxel->seed) {
      valueRow("nearest seed", three(*in.voxel->seed));
      helpTooltip("The solid voxel that jump flooding takes for the nearest: x y z");
    }
  }

  static void drawPlace(const Inspection& in, const InspectedFacet& facet) {
    drawVoxel(in);
    valueRow("area", withDigits(facet.area) + " m\u00B2");
    helpTooltip("Of the facet: the part of its plane inside the voxel, m\u00B2");
    valueRow("albedo \u03C1", three(facet.albedo));
    helpTooltip("Share of the light that arrives which is reflected diffusely: red, green, blue");
  }

  static void drawNormal(const InspectedFacet& facet) {
    const glm::dvec3& n = facet.normal;
    valueRow("normal", fmt::format("{:.3g} {:.3g} {:.3g}", n.x, n.y, n.z));
    helpTooltip("The way the facet faces, as decoded from its code: x y z of an arrow of length 1");
    valueRow("stored", fmt::format("{:#06x}, offset {:+.3f}", facet.shape & 0xFFFFu, facetOffset(facet.shape)));
    helpTooltip(
        "As the facet's record holds it: the code of its normal, and how far its plane is from the voxel's centre, "
        "voxels");
    if (!facet.mesh) return;
    valueRow("to mesh",
             fmt::format("{:.2f}\u00B0, face {:.2f}\u00B0", facet.mesh->shadingError, facet.mesh->faceError));
    helpTooltip(
        fmt::format("Angle from the decoded normal to the mesh's interpolated normal, and to the plane of the "
                    "triangle that the voxel's normal was taken from, number {}{}",
                    facet.mesh->triangle, facet.mesh->back ? ", its back" : ""));
  }

  static void drawLight(const InspectedFacet& facet, bool hasMatrix) {
    valueRow("emission M", three(facet.emission));
    helpTooltip("Emitted exitance, W/m\u00B2: red, green, blue");
    valueRow("direct D", three(facet.direct));
    helpTooltip("Direct irradiance, straight from suns, points and spots, W/m\u00B2");
    valueRow("indirect H", three(facet.irradiance));
    helpTooltip("Indirect irradiance, from other facets and the sky, W/m\u00B2");
    valueRow("radiosity B", three(facet.radiosity));
    helpTooltip("All that leaves diffusely: M + \u03C1 (D + H), W/m\u00B2");
    if (hasMatrix) {
      valueRow("residual", withDigits(facet.residual) + " W/m\u00B2");
      helpTooltip("How far one more sweep would move the radiosity B here, W/m\u00B2");
    } else {
      valueRow("std error", three(facet.standardError));
      helpTooltip("Standard error of H here, from the spread of the frames, W/m\u00B2");
    }
    if (facet.sky != glm::dvec3(0)) {
      valueRow("sky", three(facet.sky));
      helpTooltip("The part of H that comes straight from the sky, W/m\u00B2");
    }
    if (facet.reflected != glm::dvec3(0)) {
      valueRow("reflected", three(facet.reflected));
      helpTooltip("Reflections that are written back: a part of B, W/m\u00B2");
    }
    if (facet.correction != glm::dvec3(0)) {
      valueRow("emitters", three(facet.correction));
      helpTooltip(
          "F M by samples of the emitters less F M by the row's rays, W/m\u00B2: H is the row's sum with this added. "
          "It has either sign. Negative: more of this facet's rays have met emitters than the emitters' size and "
          "place call for, and what they brought too much is taken out.");
      if (facet.correction.x + facet.correction.y + facet.correction.z < 0) {
        ImGui::PushTextWrapPos(0);
        ImGui::TextColored(theme::dim, "Negative: by chance the rays met emitters too often; H is put right.");
        ImGui::PopTextWrapPos();
      }
    }
  }

  /// H over the sweeps (brute force: frames): as it came since the pick, or replayed from the dark.
  static void drawHistory(Inspection& in, bool hasMatrix) {
    std::vector<float> values;
    if (in.replay)
      for (const auto& sweep : in.replay->irradiance) values.push_back(luminance(sweep.at(0)));
    else
      for (const Inspection::Sample& sample : in.live) values.push_back(luminance(sample.irradiance));
    if (values.size() > 1) {
      const float largest = *std::max_element(values.begin(), values.end());
      const std::string name = in.replay
                                   ? fmt::format("H in {} from the dark", counted(values.size(), "sweep"))
                                   : fmt::format("H in {} since the pick", counted(in.live.back().sweep, "sweep"));
      ImGui::PlotLines("##history", values.data(), static_cast<int>(values.size()), 0, name.c_str(), 0,
                       largest > 0 ? 1.4f * largest : 1, {ImGui::GetContentRegionAvail().x, ImGui::GetFontSize() * 4});
      helpTooltip([&] { return fmt::format("Luminance, W/m\u00B2; largest {}", withDigits(largest)); });
    }
    ImGui::BeginDisabled(!hasMatrix);
    if (ImGui::Button("Solve from the dark", {-1, 0})) in.wantReplay = true;
    ImGui::EndDisabled();
    helpTooltip("Keeps H of this facet after every sweep of a solve of its own; the picture's light stays");
  }

  void drawMatrix(Inspection& in, const InspectedFacet& facet) {
    ImGui::Separator();
    using Show = Inspection::Show;
    const auto choice = [&](const char* label, Show show, const char* help) {
      if (ImGui::RadioButton(label, in.shown == show)) in.shown = show;
      helpTooltip(help);
    };
    choice("Row", Show::Row, "What this facet gathers from");
    ImGui::SameLine();
    choice("Column", Show::Column, "Who gathers from this facet");
    ImGui::SameLine();
    ImGui::BeginDisabled(!in.comparison);
    choice("Compare", Show::Comparison, "With the row of a Shift-clicked voxel's facet");
    ImGui::EndDisabled();
    if (in.shown == Show::Comparison && in.comparison) return drawComparison(in);

    const bool row = in.shown == Show::Row;
    const Links& links = row ? facet.row : facet.column;
    valueRow(row ? "row sum" : "column sum", fmt::format("{:.4f}", links.sum));
    helpTooltip(row ? "Sum of the form factors F from all that it gathers from: 1 where every ray met a facet"
                    : "Sum of the form factors F of this facet in the rows of those that gather from it");
    if (row) {
      const RayShares& r = facet.rays;
      const double n = std::max(r.rays, 1u);
      valueRow("escaped", fmt::format("{} of {}", percent(r.escaped / n), counted(r.rays, "ray")));
      helpTooltip(
          fmt::format("{} left the grid; {} ended at the back of a face", counted(r.escaped, "ray"), r.blocked));
      valueRow("invalid", percent(r.invalid / n));
      helpTooltip("Rays that began behind a surface: they do not count");
      valueRow("gathered F B", three(links.contribution));
      helpTooltip(
          "Sum of the contributions F B of the row, W/m\u00B2: H but for the emitters' samples and the residual");
    }
    valueRow("reciprocity", links.exchange > 0 ? fmt::format("{:.3f}", links.opposite / links.exchange) : "no links");
    helpTooltip("Sum of A F the other way round over that of A F: 1 but for the noise of few rays");
    const LinkTable::Result result = table_.draw(links, 2 * in.serial + (row ? 0 : 1));
    in.highlighted = result.hovered;
    if (in.linkFilterEdits != table_.edits()) {
      in.linkFilter = table_.filter();
      in.linkFilterEdits = table_.edits();
    }
    if (result.followed) in.follow = result.followed;
  }

  static void drawComparison(Inspection& in) {
    const RowComparison& rows = *in.comparison;
    valueRow("facets", fmt::format("{} and {}", in.facet()->facet, in.other->facet));
    helpTooltip("Their numbers in the facet list; the second was clicked with Shift");
    valueRow("difference", fmt::format("{:.4f}", rows.difference));
    helpTooltip("Sum of |F - F'|, of sums of 1 at most: 2 where the two rows share nothing");
    valueRow("shared", fmt::format("{:.4f}", rows.shared));
    helpTooltip("Sum of the smaller of F and F'");
    constexpr ImGuiTableFlags kFlags = ImGuiTableFlags_RowBg | ImGuiTableFlags_ScrollY;
    if (!ImGui::BeginTable("rows", 4, kFlags, {0, ImGui::GetTextLineHeightWithSpacing() * 12})) return;
    ImGui::TableSetupScrollFreeze(0, 1);
    for (const char* name : {"voxel", "F", "F'", "|F - F'|"}) ImGui::TableSetupColumn(name);
    headers({{"voxel", "Of a facet that either gathers from: x y z"},
             {"F", "Form factor to the first facet: share of its rays"},
             {"F'", "The same to the second"},
             {"|F - F'|", "By how much they differ"}});
    ImGuiListClipper clipper;
    clipper.Begin(static_cast<int>(rows.entries.size()));
    while (clipper.Step())
      for (int i = clipper.DisplayStart; i < clipper.DisplayEnd; ++i) {
        const RowComparison::Entry& entry = rows.entries[static_cast<size_t>(i)];
        ImGui::TableNextRow();
        ImGui::TableNextColumn();
        ImGui::PushID(i);
        ImGui::Selectable(three(entry.voxel).c_str(), false, ImGuiSelectableFlags_SpanAllColumns);
        ImGui::PopID();
        if (ImGui::IsItemHovered()) in.highlighted = entry.facet;
        for (const double value : {entry.a, entry.b, std::abs(entry.a - entry.b)}) {
          ImGui::TableNextColumn();
          rightText(withDigits(value));
        }
      }
    ImGui::EndTable();
  }

  void drawRay(Inspection& in, const InspectedFacet& facet) {
    ImGui::Separator();
    ImGui::SetNextItemWidth(ImGui::GetFontSize() * 7);
    ImGui::InputInt("##ray", &ray_);
    ray_ = std::clamp(ray_, 0, static_cast<int>(std::max(facet.rays.rays, 1u)) - 1);
    helpTooltip([&] { return fmt::format("Number of one of this facet's rays, 0 to {}", facet.rays.rays - 1); });
    ImGui::SameLine();
    if (ImGui::Button("Trace this ray", {-1, 0})) in.traceRay = static_cast<uint32_t>(ray_);
    helpTooltip("Walks it cell by cell, with and without the distance field, in a table below and in the picture");
    if (!in.ray) return;
    ImGui::PushTextWrapPos(0);
    ImGui::TextColored(in.ray->dda.met == in.ray->sdf.met ? theme::good : theme::warning, "Ray %u. %s", in.ray->ray,
                       describe(*in.ray).c_str());
    ImGui::PopTextWrapPos();
    drawSteps(*in.ray);
  }

  /// Both walks by distance, cells that both entered on one line.
  static void drawSteps(const InspectedRay& ray) {
    constexpr ImGuiTableFlags kFlags = ImGuiTableFlags_RowBg | ImGuiTableFlags_ScrollY | ImGuiTableFlags_BordersInnerV;
    if (!ImGui::BeginTable("steps", 4, kFlags, {0, ImGui::GetTextLineHeightWithSpacing() * 10})) return;
    ImGui::TableSetupScrollFreeze(0, 1);
    ImGui::TableSetupColumn("t", ImGuiTableColumnFlags_WidthFixed, ImGui::CalcTextSize("000.00").x);
    ImGui::TableSetupColumn("DDA", ImGuiTableColumnFlags_WidthStretch);
    ImGui::TableSetupColumn("SDF", ImGuiTableColumnFlags_WidthStretch);
    ImGui::TableSetupColumn("skips", ImGuiTableColumnFlags_WidthFixed, ImGui::CalcTextSize("skips").x);
    headers({{"t", "How far along the ray, voxels"},
             {"DDA", "Cells that a walk from voxel to voxel enters: x y z; coloured where they hold facets"},
             {"SDF", "Cells that the walk through the distance field enters"},
             {"skips", "How far the field lets it go on from there, voxels"}});
    const std::vector<RayStep>&dda = ray.dda.steps, &sdf = ray.sdf.steps;
    for (size_t d = 0, s = 0; d < dda.size() || s < sdf.size();) {
      const bool both = d < dda.size() && s < sdf.size() && dda[d].cell == sdf[s].cell;
      const bool first = both || s == sdf.size() || (d < dda.size() && dda[d].t <= sdf[s].t);
      ImGui::TableNextRow();
      ImGui::TableNextColumn();
      rightText(fmt::format("{:.2f}", first ? dda[d].t : sdf[s].t));
      ImGui::TableNextColumn();
      if (first) drawCell(dda[d]);
      ImGui::TableNextColumn();
      if (both || !first) {
        drawCell(sdf[s]);
        ImGui::TableNextColumn();
        rightText(fmt::format("{:.1f}", sdf[s].length));
      }
      s += both || !first;
      d += first;
    }
    ImGui::EndTable();
  }
  /// Of a table's columns: their names and what they mean.
  static void headers(std::initializer_list<std::pair<const char*, const char*>> columns) {
    ImGui::TableNextRow(ImGuiTableRowFlags_Headers);
    for (const auto& [name, help] : columns) {
      ImGui::TableNextColumn();
      ImGui::TableHeader(name);
      helpTooltip(help);
    }
  }
  static void drawCell(const RayStep& step) {
    const std::string text = fmt::format("{} {} {}", step.cell.x, step.cell.y, step.cell.z);
    ImGui::TextColored(step.faces > 0 ? theme::accent : theme::text, "%s", text.c_str());
    if (step.faces > 0) helpTooltip("holds " + counted(step.faces, "facet"));
  }

  LinkTable table_;
  int ray_ = 0;
};

}  // namespace

std::unique_ptr<Panel> makeInspectorPanel() {
  return std::make_unique<InspectorPanel>();
}

}  // namespace irad
