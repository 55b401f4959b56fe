// GPU milliseconds per stage over the last frames, and a plot of whole frames.
#include <fmt/format.h>
#include <imgui.h>

#include <algorithm>
#include <numeric>

#include "ui/panel.h"
#include "ui/theme.h"
#include "ui/widgets.h"

namespace irad {
namespace {

constexpr size_t kWindow = 300;  ///< frames that statistics and plot look back on

std::string milliseconds(double value) {
  return value < 10     ? fmt::format("{:.2f}", value)
         : value < 1000 ? fmt::format("{:.1f}", value)
                        : fmt::format("{:.0f}", value);
}

class TimingsPanel : public Panel {
 public:
  const char* title() const override { return "Timings"; }
  Region region() const override { return Region::Bottom; }

  void draw(Session& session) override {
    update(session.context.timings);
    const ImVec2 space = ImGui::GetContentRegionAvail();
    const float gap = ImGui::GetStyle().ItemSpacing.x;
    const float table = std::floor(space.x * 0.72f);
    drawTable({table, space.y});
    ImGui::SameLine(0, gap);
    drawPlot({space.x - table - gap, space.y});
  }

 private:
  uint64_t seen_ = UINT64_MAX;
  std::vector<Timings::Row> rows_;
  std::vector<float> frames_;  ///< GPU ms of the frames that rendered a picture

  /// Statistics of the last kWindow frames, and of all one-time work; only when a frame has been added.
  void update(const Timings& timings) {
    if (timings.recorded() == seen_) return;
    seen_ = timings.recorded();
    rows_ = timingRows(stageSamples(timings.frames(), kWindow));
    std::stable_sort(rows_.begin(), rows_.end(), [](const auto& a, const auto& b) { return a.kind > b.kind; });
    frames_.clear();
    for (const FrameSample& frame : timings.frames())
      if (std::any_of(frame.stages.begin(), frame.stages.end(), [](auto& s) { return s.first == "RE Forward"; }))
        frames_.push_back(static_cast<float>(frame.gpuMs()));
  }

  void drawTable(ImVec2 size) const {
    constexpr std::array columns{"stage (GPU ms)", "mean", "min", "max", "p95", "samples"};
    if (!ImGui::BeginTable("timings", static_cast<int>(columns.size()), ImGuiTableFlags_RowBg | ImGuiTableFlags_ScrollY,
                           size))
      return;
    const float number = ImGui::CalcTextSize("00000.0").x;
    ImGui::TableSetupScrollFreeze(0, 1);
    for (size_t i = 0; i < columns.size(); ++i)
      ImGui::TableSetupColumn(columns[i],
                              i == 0 ? ImGuiTableColumnFlags_WidthStretch : ImGuiTableColumnFlags_WidthFixed,
                              i == 0 ? 1.0f : number);
    ImGui::TableNextRow(ImGuiTableRowFlags_Headers);
    for (size_t i = 0; i < columns.size(); ++i) {
      ImGui::TableSetColumnIndex(static_cast<int>(i));
      ImGui::PushStyleColor(ImGuiCol_Text, theme::dim);
      if (i == 0)
        ImGui::TextUnformatted(columns[i]);
      else
        rightText(columns[i]);
      ImGui::PopStyleColor();
    }
    for (const Timings::Row& row : rows_) {
      ImGui::TableNextRow();
      ImGui::TableNextColumn();
      clippedText(row.kind == WorkKind::Setup ? row.stage + " (once)" : row.stage, ImGui::GetContentRegionAvail().x);
      for (const double value : {row.stats.mean, row.stats.min, row.stats.max, row.stats.p95}) {
        ImGui::TableNextColumn();
        rightText(milliseconds(value));
      }
      ImGui::TableNextColumn();
      rightText(fmt::format("{}", row.stats.samples));
    }
    ImGui::EndTable();
  }

  void drawPlot(ImVec2 size) const {
    if (size.x < 40 || size.y < 30) return;
    const ImVec2 low = ImGui::GetCursorScreenPos();
    const ImVec2 high{low.x + size.x, low.y + size.y};
    ImGui::Dummy(size);
    ImDrawList& list = *ImGui::GetWindowDrawList();
    list.AddRectFilled(low, high, ImGui::GetColorU32(ImGuiCol_FrameBg), ImGui::GetStyle().FrameRounding);
    constexpr float pad = 6;
    if (frames_.empty()) {
      list.AddText({low.x + pad, low.y + 4}, ImGui::GetColorU32(theme::dim), "no frame yet");
      return;
    }
    // One bar of two pixels per picture, the newest at the right edge.
    const float line = ImGui::GetTextLineHeight(), step = 2;
    const ImVec2 plotLow{low.x + pad, low.y + line + 8}, plotHigh{high.x - pad, high.y - pad};
    const auto shown = std::min(frames_.size(), static_cast<size_t>((plotHigh.x - plotLow.x) / step));
    const float largest = *std::max_element(frames_.end() - static_cast<ptrdiff_t>(shown), frames_.end());
    for (size_t i = 0; i < shown; ++i) {
      const float x = plotHigh.x - step * static_cast<float>(i + 1);
      const float y =
          plotHigh.y - frames_[frames_.size() - 1 - i] / std::max(largest, 1e-3f) * (plotHigh.y - plotLow.y);
      list.AddRectFilled({x, y}, {x + step, plotHigh.y}, ImGui::GetColorU32(theme::plotFill));
      list.AddRectFilled({x, y}, {x + step, std::min(y + 2, plotHigh.y)}, ImGui::GetColorU32(theme::plotLine));
    }
    const std::string title = fmt::format("picture {} ms", milliseconds(frames_.back()));
    const ImVec4 clip{low.x, low.y, high.x, high.y};
    list.AddText(nullptr, 0, {low.x + pad, low.y + 4}, ImGui::GetColorU32(theme::dim), title.c_str(), nullptr, 0,
                 &clip);
    const float offset = (plotHigh.x - ImGui::GetMousePos().x) / step;
    if (offset > 0 && offset < static_cast<float>(shown))
      helpTooltip(
          fmt::format("GPU time of a picture, all stages and the panels\n{} ms, {} pictures ago; largest shown {} ms",
                      milliseconds(frames_[frames_.size() - 1 - static_cast<size_t>(offset)]),
                      static_cast<size_t>(offset), milliseconds(largest)));
  }
};

}  // namespace

std::unique_ptr<Panel> makeTimingsPanel() {
  return std::make_unique<TimingsPanel>();
}

}  // namespace irad
