#include "ui/link_table.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>

#include "ui/imgui.h"
#include "ui/theme.h"
#include "ui/widgets.h"
#include "ui/words.h"

namespace irad {
namespace {

struct Column {
  const char *name, *help;
  const char* widest;  ///< text that has room at first
  LinkQuantity quantity;
  bool hidden;  ///< at first, as are those that there is no room for
};

const std::array kColumns{
    Column{"voxel", "The voxel of the other facet: x y z, from 0", "000 000 000", LinkQuantity::voxel, false},
    Column{"F B", "Contribution to the receiver's H, luminance, W/m\u00B2", "0.00e-00", LinkQuantity::FB, false},
    Column{"F", "Form factor: share of the receiver's rays", "0.00e-00", LinkQuantity::F, false},
    Column{"m", "Distance between the two facets, metres", "00.00", LinkQuantity::dist, false},
    Column{"hits", "Rays of the receiver that met the sender", "000000", LinkQuantity::hits, false},
    Column{"B", "Radiosity of the sender, luminance, W/m\u00B2", "0.00e-00", LinkQuantity::B, true},
    Column{"back", "Reciprocity: A F the other way round over A F, 1 but for the noise of few rays", "00.00",
           LinkQuantity::back, true},
    Column{"facet", "Number of the other facet in the list of facets", "0000000", LinkQuantity::facet, true},
};

std::string text(const Link& l, size_t column) {
  const LinkQuantity quantity = kColumns[column].quantity;
  if (quantity == LinkQuantity::voxel) return voxelText(l);
  const double value = quantityOf(l, quantity);
  return quantity == LinkQuantity::hits || quantity == LinkQuantity::facet ? fmt::format("{:.0f}", value)
                                                                           : withDigits(value);
}

}  // namespace

void LinkTable::order(const Links& links, const ImGuiTableSortSpecs& specs) {
  rows_.clear();
  for (uint32_t i = 0; i < links.links.size(); ++i)
    if (filter_.passes(links.links[i])) rows_.push_back(i);
  if (specs.SpecsCount == 0) return;
  const LinkQuantity by = kColumns.at(static_cast<size_t>(specs.Specs[0].ColumnIndex)).quantity;
  const bool up = specs.Specs[0].SortDirection == ImGuiSortDirection_Ascending;
  std::stable_sort(rows_.begin(), rows_.end(), [&](uint32_t a, uint32_t b) {
    const double x = quantityOf(links.links[a], by), y = quantityOf(links.links[b], by);
    return up ? x < y : x > y;
  });
}

LinkTable::Result LinkTable::draw(const Links& links, uint64_t serial) {
  Result result;
  ImGui::SetNextItemWidth(-1);
  if (ImGui::InputTextWithHint("##filter", "filter: 12 3, -40, hits>=3 \u2026", &typed_)) {
    filter_ = LinkFilter(typed_);
    filtered_ = true;
    ++edits_;
  }
  if (!ImGui::IsItemActive()) helpTooltip(LinkFilter::help());  // while typing, people look at the table
  for (const std::string& error : filter_.errors()) {
    ImGui::PushTextWrapPos(0);
    ImGui::TextColored(theme::error, "%s", error.c_str());
    ImGui::PopTextWrapPos();
  }

  constexpr ImGuiTableFlags kFlags = ImGuiTableFlags_RowBg | ImGuiTableFlags_Sortable | ImGuiTableFlags_Hideable |
                                     ImGuiTableFlags_Resizable | ImGuiTableFlags_ScrollX | ImGuiTableFlags_ScrollY;
  const float height = ImGui::GetTextLineHeightWithSpacing() * 12, width = ImGui::GetContentRegionAvail().x;
  if (!ImGui::BeginTable("links", static_cast<int>(kColumns.size()), kFlags, {0, height})) return result;
  ImGui::TableSetupScrollFreeze(0, 1);
  // A column that is cut off would show half of its numbers: what has no room beside the others is hidden at first.
  float room = width - ImGui::GetStyle().ScrollbarSize;
  for (size_t c = 0; c < kColumns.size(); ++c) {
    ImGuiTableColumnFlags flags = ImGuiTableColumnFlags_WidthFixed | ImGuiTableColumnFlags_PreferSortDescending;
    room -= ImGui::CalcTextSize(kColumns[c].widest).x + 2 * ImGui::GetStyle().CellPadding.x;
    if (kColumns[c].hidden || room < 0) flags |= ImGuiTableColumnFlags_DefaultHide;
    if (kColumns[c].quantity == LinkQuantity::FB) flags |= ImGuiTableColumnFlags_DefaultSort;
    ImGui::TableSetupColumn(kColumns[c].name, flags, ImGui::CalcTextSize(kColumns[c].widest).x);
  }
  ImGui::TableNextRow(ImGuiTableRowFlags_Headers);
  for (size_t c = 0; c < kColumns.size(); ++c)
    if (ImGui::TableSetColumnIndex(static_cast<int>(c))) {
      ImGui::TableHeader(kColumns[c].name);
      helpTooltip([&] {
        return fmt::format("{}\nClick: sort by it. Right click: choose the columns, of which there are more.",
                           kColumns[c].help);
      });
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
  ImGui::TextColored(theme::dim, "%zu of %zu %s; double click: follow", rows_.size(), links.links.size(),
                     links.links.size() == 1 ? "link" : "links");
  return result;
}

}  // namespace irad
