#include "ui/link_table.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>

#include "shaders/shared/emitters.h"
#include "ui/theme.h"
#include "ui/widgets.h"

namespace irad {
namespace {

struct Column {
  const char *name, *help;
  const char* widest;  ///< text that has room at first
  double (*value)(const Link&);
  bool hidden;  ///< at first
};

double voxelOrder(const Link& l) {
  return l.voxel.x + 1024.0 * (l.voxel.y + 1024.0 * l.voxel.z);
}

const std::array kColumns{
    Column{"voxel", "x y z of the far end", "000 000 000", voxelOrder, false},
    Column{"hits", "Rays of the receiver that met the sender", "000000", [](const Link& l) -> double { return l.hits; },
           false},
    Column{"m", "Distance between the two facets", "00.00", [](const Link& l) { return l.distance; }, false},
    Column{"F B", "Contribution to the receiver's H, luminance, W/m\u00B2", "0.00e-00",
           [](const Link& l) -> double { return luminance(glm::vec3(l.contribution)); }, false},
    Column{"F", "Form factor: share of the receiver's rays", "0.00e-00", [](const Link& l) { return l.formFactor; },
           true},
    Column{"B", "Radiosity of the sender, luminance, W/m\u00B2", "0.00e-00",
           [](const Link& l) -> double { return luminance(glm::vec3(l.radiosity)); }, true},
    Column{"back", "Reciprocity: A F the other way round over A F, 1 but for the noise of few rays", "00.00",
           [](const Link& l) { return l.opposite / l.exchange; }, true},
    Column{"facet", "Index of the far end", "0000000", [](const Link& l) -> double { return l.facet; }, true},
};

std::string text(const Link& l, size_t column) {
  if (column == 0) return fmt::format("{} {} {}", l.voxel.x, l.voxel.y, l.voxel.z);
  const double value = kColumns[column].value(l);
  return column == 1 || column == 7 ? fmt::format("{:.0f}", value) : shortNumber(value);
}

}  // namespace

void LinkTable::order(const Links& links, const ImGuiTableSortSpecs& specs) {
  rows_.clear();
  for (uint32_t i = 0; i < links.links.size(); ++i)
    if (filter_.PassFilter(text(links.links[i], 0).c_str())) rows_.push_back(i);
  if (specs.SpecsCount == 0) return;
  const auto value = kColumns.at(static_cast<size_t>(specs.Specs[0].ColumnIndex)).value;
  const bool up = specs.Specs[0].SortDirection == ImGuiSortDirection_Ascending;
  std::stable_sort(rows_.begin(), rows_.end(), [&](uint32_t a, uint32_t b) {
    const double x = value(links.links[a]), y = value(links.links[b]);
    return up ? x < y : x > y;
  });
}

LinkTable::Result LinkTable::draw(const Links& links, uint64_t serial) {
  Result result;
  ImGui::SetNextItemWidth(-1);
  filtered_ |= ImGui::InputTextWithHint("##filter", "filter: 12 3, -40 \u2026", filter_.InputBuf,
                                        IM_ARRAYSIZE(filter_.InputBuf));
  helpTooltip("Shows the voxels whose \"x y z\" contains one of these, and none that begins with -");
  if (filtered_) filter_.Build();

  constexpr ImGuiTableFlags kFlags = ImGuiTableFlags_RowBg | ImGuiTableFlags_Sortable | ImGuiTableFlags_Hideable |
                                     ImGuiTableFlags_Resizable | ImGuiTableFlags_ScrollX | ImGuiTableFlags_ScrollY;
  const float height = ImGui::GetTextLineHeightWithSpacing() * 12;
  if (!ImGui::BeginTable("links", static_cast<int>(kColumns.size()), kFlags, {0, height})) return result;
  ImGui::TableSetupScrollFreeze(0, 1);
  for (size_t c = 0; c < kColumns.size(); ++c) {
    ImGuiTableColumnFlags flags = ImGuiTableColumnFlags_WidthFixed | ImGuiTableColumnFlags_PreferSortDescending;
    if (kColumns[c].hidden) flags |= ImGuiTableColumnFlags_DefaultHide;
    if (c == 3) flags |= ImGuiTableColumnFlags_DefaultSort;
    ImGui::TableSetupColumn(kColumns[c].name, flags, ImGui::CalcTextSize(kColumns[c].widest).x);
  }
  ImGui::TableNextRow(ImGuiTableRowFlags_Headers);
  for (size_t c = 0; c < kColumns.size(); ++c)
    if (ImGui::TableSetColumnIndex(static_cast<int>(c))) {
      ImGui::TableHeader(kColumns[c].name);
      helpTooltip(kColumns[c].help);
    }
  ImGuiTableSortSpecs* specs = ImGui::TableGetSortSpecs();
  if (specs->SpecsDirty || filtered_ || serial_ != serial) {
    order(links, *specs);
    specs->SpecsDirty = filtered_ = false;
    serial_ = serial;
  }

  ImGuiListClipper clipper;
  clipper.Begin(static_cast<int>(rows_.size()));
  while (clipper.Step())
    for (int row = clipper.DisplayStart; row < clipper.DisplayEnd; ++row) {
      const Link& link = links.links[rows_[static_cast<size_t>(row)]];
      ImGui::TableNextRow();
      for (size_t c = 0; c < kColumns.size(); ++c) {
        if (!ImGui::TableSetColumnIndex(static_cast<int>(c))) continue;
        if (c > 0) {
          rightText(text(link, c));
          continue;
        }
        ImGui::PushID(row);
        ImGui::Selectable(text(link, c).c_str(), false,
                          ImGuiSelectableFlags_SpanAllColumns | ImGuiSelectableFlags_AllowDoubleClick);
        ImGui::PopID();
        if (!ImGui::IsItemHovered()) continue;
        result.hovered = link.facet;
        if (ImGui::IsMouseDoubleClicked(ImGuiMouseButton_Left)) result.followed = link.facet;
      }
    }
  ImGui::EndTable();
  ImGui::TextColored(theme::dim, "%zu of %zu links; double click: follow", rows_.size(), links.links.size());
  return result;
}

}  // namespace irad
