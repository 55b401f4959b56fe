// Device memory as the allocator counts it: subtotals per subsystem, each opening into its buffers and images.
#include <fmt/format.h>
#include <imgui.h>

#include <map>

#include "ui/panel.h"
#include "ui/theme.h"
#include "ui/widgets.h"

namespace irad {
namespace {

class MemoryPanel : public Panel {
 public:
  const char* title() const override { return "Memory"; }
  Region region() const override { return Region::Right; }

  void draw(Session& session) override {
    const Allocator& memory = session.context.device.memory();
    const double share =
        static_cast<double>(memory.used()) / static_cast<double>(std::max<uint64_t>(memory.budget(), 1));
    ImGui::ProgressBar(static_cast<float>(share), {-1, ImGui::GetFontSize() * 0.5f}, "");
    valueRow("used", fmt::format("{} of {}", mebibytes(memory.used()), mebibytes(memory.budget())));
    valueRow("peak", mebibytes(memory.peak()));

    // Grouped in the enumeration's order; within a subsystem largest first, as the allocator gives them.
    std::map<Subsystem, std::vector<MemoryRow>> groups;
    for (MemoryRow& row : session.context.device.memory().rows()) groups[row.subsystem].push_back(std::move(row));
    if (!ImGui::BeginTable("memory", 2, ImGuiTableFlags_RowBg)) return;
    ImGui::TableSetupColumn("name", ImGuiTableColumnFlags_WidthStretch);
    ImGui::TableSetupColumn("size", ImGuiTableColumnFlags_WidthFixed, ImGui::CalcTextSize("00000.0 MiB").x);
    for (const auto& [subsystem, rows] : groups) drawGroup(toString(subsystem), rows);
    ImGui::EndTable();
  }

 private:
  static void drawGroup(const char* name, const std::vector<MemoryRow>& rows) {
    uint64_t total = 0;
    for (const MemoryRow& row : rows) total += row.bytes;
    ImGui::TableNextRow();
    ImGui::TableNextColumn();
    const bool open = ImGui::TreeNodeEx(name, ImGuiTreeNodeFlags_SpanFullWidth);
    ImGui::TableNextColumn();
    rightText(mebibytes(total));
    if (!open) return;
    for (const MemoryRow& row : rows) {
      ImGui::TableNextRow();
      ImGui::TableNextColumn();
      ImGui::PushStyleColor(ImGuiCol_Text, theme::dim);
      clippedText(row.name, ImGui::GetContentRegionAvail().x);
      helpTooltip(fmt::format("{}\n{}\n{} bytes", row.name, row.format, withThousands(row.bytes)));
      ImGui::TableNextColumn();
      rightText(mebibytes(row.bytes));
      ImGui::PopStyleColor();
    }
    ImGui::TreePop();
  }
};

}  // namespace

std::unique_ptr<Panel> makeMemoryPanel() {
  return std::make_unique<MemoryPanel>();
}

}  // namespace irad
