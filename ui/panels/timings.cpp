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
  struct Row {
    std::string stage;
    bool setup;
    TimingStats stats;
  };
  uint64_t seen_ = UINT64_MAX;
  std::vector<Row> rows_;
  std::vector<float> frames_;  ///< GPU ms of the frames that rendered a picture

  /// Statistics of the last kWindow frames, and of all one-time work; only when a frame has been added.
  void update(const Timings& timings) {
    const auto& frames = timings.frames();
    if (timings.recorded() == seen_) return;
    seen_ = timings.recorded();
    std::vector<std::pair<Row, std::vector<double>>> found;
    frames_.clear();
    const size_t first = frames.size() > kWindow ? frames.size() - kWindow : 0;
    for (size_t i = 0; i < frames.size(); ++i) {
      const Timings::FrameSample& frame = frames[i];
      if (i < first && !frame.setup) continue;
      double total = 0;
      for (const auto& [stage, ms] : frame.stages) {
        total += ms;
        auto row = std::find_if(found.begin(), found.end(), [&, &name = stage](const auto& f) {
          return f.first.stage == name && f.first.setup == frame.setup;
        });
        if (row == found.end()) row = found.insert(found.end(), {Row{stage, frame.setup, {}}, {}});
        row->second.push_back(ms);
      }
      const bool picture =
          std::any_of(frame.stages.begin(), frame.stages.end(), [](const auto& s) { return s.first == "RE Forward"; });
      if (!frame.setup && picture) frames_.push_back(static_cast<float>(total));
    }
    rows_.clear();
    for (auto& [row, samples] : found) {
      row.stats = statistics(std::move(samples));
      rows_.push_back(std::move(row));
    }
    std::stable_sort(rows_.begin(), rows_.end(), [](const Row& a, const Row& b) { return a.setup < b.setup; });
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
    for (const Row& row : rows_) {
      ImGui::TableNextRow();
      ImGui::TableNextColumn();
      clippedText(row.setup ? row.stage + " (once)" : row.stage, ImGui::GetContentRegionAvail().x);
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
