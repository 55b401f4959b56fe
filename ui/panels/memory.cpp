// Device memory: every buffer and image as the allocator measured it, beside what its formula predicts (docs/method.md
// 10), with subtotals per subsystem; T eq. 29-31; the heap's budget.
#include <fmt/format.h>

#include <algorithm>

#include "gi/memory_report.h"
#include "ui/imgui.h"
#include "ui/panel.h"
#include "ui/theme.h"
#include "ui/widgets.h"
#include "ui/words.h"

namespace irad {
namespace {

std::string bytesText(const std::optional<uint64_t>& bytes) {
  if (!bytes) return {};
  if (*bytes < 100) return fmt::format("{} B", *bytes);
  return *bytes < 100 * 1024 ? fmt::format("{:.1f} KiB", static_cast<double>(*bytes) / 1024) : mebibytes(*bytes);
}

class MemoryPanel : public Panel {
 public:
  const char* title() const override { return "Memory"; }
  const char* help() const override {
    return "The device's memory: what every buffer and image takes, beside what its formula predicts";
  }
  Region region() const override { return Region::Right; }

  void draw(Session& session) override {
    const Allocator& memory = session.context.device.memory();
    const double share =
        static_cast<double>(memory.used()) / static_cast<double>(std::max<uint64_t>(memory.budget(), 1));
    ImGui::ProgressBar(static_cast<float>(share), {-1, ImGui::GetFontSize() * 0.5f}, "");
    valueRow("used", fmt::format("{} of {}", mebibytes(memory.used()), mebibytes(memory.budget())));
    helpTooltip("Device memory in use, of what this process may take of the device's heap (MiB of 1,048,576 bytes)");
    valueRow("peak", mebibytes(memory.peak()));
    helpTooltip("The most device memory that was in use at any time since the program began");
    if (ImGui::Button("Save CSV", {-1, 0})) session.recorder.memory = true;
    helpTooltip("Every row of this table in bytes, into a new folder");

    // In the middle of a rebuild the pipeline's products come and go.
    if (session.built && !session.work && refresh_.due(session)) update(session);
    if (!ImGui::BeginTable("memory", 3, ImGuiTableFlags_RowBg)) return;
    const float number = ImGui::CalcTextSize("0000.0 MiB").x;
    ImGui::TableSetupColumn("name", ImGuiTableColumnFlags_WidthStretch);
    ImGui::TableSetupColumn("measured", ImGuiTableColumnFlags_WidthFixed, number);
    ImGui::TableSetupColumn("predicted", ImGuiTableColumnFlags_WidthFixed, number);
    ImGui::TableNextRow(ImGuiTableRowFlags_Headers);
    ImGui::PushStyleColor(ImGuiCol_Text, theme::dim);
    ImGui::TableNextColumn();
    ImGui::TableNextColumn();
    rightText("measured");
    helpTooltip("What the allocator gave, MiB of 1,048,576 bytes");
    ImGui::TableNextColumn();
    rightText("predicted");
    helpTooltip("By the formulas from the numbers of voxels, facets and rays; empty where there is none");
    ImGui::PopStyleColor();
    for (const Group& group : groups_) drawGroup(group);
    ImGui::EndTable();
  }

 private:
  /// A subsystem and what is in it.
  struct Group {
    std::string name;
    std::optional<uint64_t> measured, predicted;  ///< predicted: where it is for every row
    std::vector<MemoryReportRow> rows;
  };
  std::vector<Group> groups_;
  Refresh refresh_;

  void update(const Session& session) {
    const Pipeline& p = *session.pipeline;
    groups_.clear();
    const std::vector<MemoryReportRow> report = memoryReport(session.context.device.memory().rows(), p);
    for (const MemoryReportRow& row : report)
      if (row.kind == MemoryReportRow::Kind::Subtotal)
        groups_.push_back({row.subsystem, row.measured, uint64_t{0}, {}});
    std::sort(groups_.begin(), groups_.end(), [](const Group& a, const Group& b) { return a.measured > b.measured; });
    Group sums{"total", std::nullopt, std::nullopt, {}};
    for (const MemoryReportRow& row : report) {
      if (row.kind == MemoryReportRow::Kind::Sum && row.predicted) sums.rows.push_back(row);  // T eq. 29-31
      const auto group = std::find_if(groups_.begin(), groups_.end(), [&](auto& g) { return g.name == row.subsystem; });
      if (row.kind != MemoryReportRow::Kind::Resource || group == groups_.end()) continue;
      group->rows.push_back(row);
      group->predicted =
          group->predicted && row.predicted ? std::optional(*group->predicted + *row.predicted) : std::nullopt;
    }
    sums.measured = session.context.device.memory().used();
    groups_.push_back(std::move(sums));
  }

  static void drawGroup(const Group& group) {
    ImGui::TableNextRow();
    ImGui::TableNextColumn();
    const bool open = ImGui::TreeNodeEx(group.name.c_str(), ImGuiTreeNodeFlags_SpanFullWidth);
    helpTooltip("What its buffers and images take together; click: each of them");
    for (const auto& bytes : {group.measured, group.predicted}) {
      ImGui::TableNextColumn();
      rightText(bytesText(bytes));
    }
    if (!open) return;
    for (const MemoryReportRow& row : group.rows) drawRow(row);
    ImGui::TreePop();
  }

  static void drawRow(const MemoryReportRow& row) {
    ImGui::TableNextRow();
    ImGui::TableNextColumn();
    clippedText(row.name, ImGui::GetContentRegionAvail().x);
    helpTooltip([&] {
      return fmt::format("{}\n{}\n{} measured{}", row.name, row.format, counted(row.measured.value_or(0), "byte"),
                         row.predicted ? fmt::format(", {} predicted", withThousands(*row.predicted)) : "");
    });
    if (!row.format.empty()) {
      ImGui::PushStyleColor(ImGuiCol_Text, theme::dim);
      clippedText(row.format, ImGui::GetContentRegionAvail().x);
      ImGui::PopStyleColor();
    }
    for (const auto& bytes : {row.measured, row.predicted}) {
      ImGui::TableNextColumn();
      rightText(bytesText(bytes));
    }
  }
};

}  // namespace

std::unique_ptr<Panel> makeMemoryPanel() {
  return std::make_unique<MemoryPanel>();
}

}  // namespace irad
