// Milliseconds per stage: a plot of the last frames with their composition, the tables of T 6-10, recordings compared.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "ui/imgui.h"
#include "ui/panel.h"
#include "ui/plot.h"
#include "ui/recording_comparison.h"
#include "ui/theme.h"
#include "ui/timing_history.h"
#include "ui/widgets.h"

namespace irad {
namespace {

constexpr std::array<size_t, 4> kWindows{300, 600, 1000, TimingHistory::kMost};  ///< frames looked back on
constexpr const char* kPicture = "RE Forward";  ///< frames that ran it drew a picture; others relit or drew panels

std::string withUnit(double value) {
  if (value == 0) return "0 ms";
  return value < 0.01 && value > 0 ? fmt::format("{:.2g} ms", value) : milliseconds(value) + " ms";
}

class TimingsPanel : public Panel {
 public:
  const char* title() const override { return "Timings"; }
  const char* help() const override {
    return "What each stage takes on the GPU: frame by frame, as a table, by build; recordings compared";
  }
  Region region() const override { return Region::Bottom; }

  void draw(Session& session) override {
    if (!paused_) history_.update(session.context.timings);
    const ImVec2 begin = ImGui::GetCursorPos();
    if (drawControls(session)) ImGui::SetCursorPos(begin);
    if (!ImGui::BeginTabBar("tabs")) return;
    const auto tab = [](const char* name, const char* help) {
      const bool shown = ImGui::BeginTabItem(name);
      helpTooltip(help);
      return shown;
    };
    if (tab("Plot", "Milliseconds of each stage over the last frames, and of one frame what it is made of")) {
      drawPlot();
      ImGui::EndTabItem();
    }
    if (tab("Table", "Mean, extremes and percentiles of each stage over the last frames")) {
      drawTable(session);
      ImGui::EndTabItem();
    }
    if (tab("One-time", "What each stage of a build took, by scene and resolution")) {
      drawOneTime();
      ImGui::EndTabItem();
    }
    if (tab("Compare", "Two recordings, stage by stage")) {
      comparison_.draw(session.recorder);
      ImGui::EndTabItem();
    }
    ImGui::EndTabBar();
  }

 private:
  TimingHistory history_;
  bool paused_ = false, logarithmic_ = false;
  size_t window_ = kWindows[0];
  /// Of the frames looked back on or, where the stage did not run in these, when it last did.
  struct Row {
    std::string stage;
    TimingStats stats;
    bool old;
  };
  std::vector<Row> rows_;
  uint64_t rowsOf_ = UINT64_MAX;  ///< Timings::recorded() that rows_ are of
  size_t rowsWindow_ = 0;
  Refresh refresh_;
  RecordingComparison comparison_;

  /// At the right end of the tabs' line, or on a line of their own where there is no room: then false.
  bool drawControls(Session& session) {
    const ImGuiStyle& style = ImGui::GetStyle();
    const std::string record =
        session.recorder.began
            ? fmt::format("Stop {:.1f} s", 1e-3 * (session.context.timings.now() - *session.recorder.began))
            : std::string("Record");
    const auto button = [&](const char* text) { return ImGui::CalcTextSize(text).x + 2 * style.FramePadding.x; };
    const float combo = button("3000 frames") + ImGui::GetFrameHeight();
    const float log = ImGui::GetFrameHeight() + style.ItemInnerSpacing.x + ImGui::CalcTextSize("log").x;
    const float width = log + combo + button("Resume") + button("Stop 000.0 s") + 3 * style.ItemSpacing.x;
    float tabs = 0;
    for (const char* tab : {"Plot", "Table", "One-time", "Compare"}) tabs += button(tab) + style.ItemInnerSpacing.x;
    const float rest = ImGui::GetContentRegionAvail().x - width;
    ImGui::SetCursorPosX(ImGui::GetCursorPosX() + std::max(0.0f, rest));
    ImGui::Checkbox("log", &logarithmic_);
    helpTooltip("The plot's milliseconds on a logarithmic axis, so that short stages are seen beside long ones");
    ImGui::SameLine();
    ImGui::SetNextItemWidth(combo);
    if (ImGui::BeginCombo("##window", fmt::format("{} frames", window_).c_str())) {
      for (const size_t frames : kWindows)
        if (ImGui::Selectable(fmt::format("{} frames", frames).c_str(), frames == window_)) window_ = frames;
      ImGui::EndCombo();
    }
    helpTooltip("How many of the last frames plot and table are of");
    ImGui::SameLine();
    if (ImGui::Button(paused_ ? "Resume###pause" : "Pause###pause", {button("Resume"), 0})) paused_ = !paused_;
    helpTooltip("Holds plot and tables; the program goes on");
    ImGui::SameLine();
    // In a narrow window as wide as there is room.
    const float wide = std::min(button("Stop 000.0 s"), ImGui::GetContentRegionAvail().x);
    if (ImGui::Button((clipped(record, wide - 2 * style.FramePadding.x) + "###record").c_str(), {wide, 0}))
      session.recorder.toggle = true;
    helpTooltip(
        "Draws pictures without pause until it is stopped, and writes frames.csv, summary.csv and trace.json "
        "(for Perfetto) into a new folder");
    return rest >= tabs;
  }

  // ---- Plot ----

  void drawPlot() {
    if (history_.size() == 0) {
      ImGui::TextColored(theme::dim, "no frame yet");
      return;
    }
    const ImVec2 space = ImGui::GetContentRegionAvail();
    const float em = ImGui::GetFontSize();
    const float list = std::floor(std::min(std::clamp(0.3f * space.x, 11 * em, 13 * em), 0.5f * space.x));
    const size_t first = history_.size() - std::min(window_, history_.size());
    // The list is drawn beside the plot but shows the frame under the mouse in the plot.
    const ImVec2 begin = ImGui::GetCursorPos();
    ImGui::SetCursorPosX(begin.x + list + ImGui::GetStyle().ItemSpacing.x);
    ImGui::BeginGroup();
    const float bars = 2 * ImGui::GetTextLineHeightWithSpacing() + ImGui::GetStyle().ItemSpacing.y;
    const ImVec2 rest = ImGui::GetContentRegionAvail();
    const std::optional<size_t> hovered = drawLines({rest.x, rest.y - bars}, first);
    const size_t frame = hovered.value_or(std::min(history_.lastWith(kPicture, window_), history_.size() - 1));
    drawBars(frame);
    ImGui::EndGroup();
    ImGui::SetCursorPos(begin);
    drawStages({list, space.y}, frame);
  }

  /// Returns the frame under the mouse.
  std::optional<size_t> drawLines(ImVec2 size, size_t first) {
    const size_t count = history_.size() - first;
    const size_t columns = std::clamp<size_t>(static_cast<size_t>(size.x / 2), 1, count);
    std::vector<float> x(columns);
    for (size_t i = 0; i < columns; ++i)  // the last frame of each, before the newest
      x[i] = -static_cast<float>(count - (i + 1) * count / columns);
    std::vector<std::vector<float>> values;
    std::vector<PlotLine> lines;
    values.reserve(history_.stages().size());
    for (size_t s = 0; s < history_.stages().size(); ++s) {
      const TimingHistory::Stage& stage = history_.stages()[s];
      if (!stage.shown) continue;
      values.push_back(TimingHistory::peaks(stage.ms, first, columns));
      lines.push_back({stage.name, seriesColor(s), values.back()});
    }
    PlotAxes axes;
    axes.logarithmic = logarithmic_;
    axes.x = x;
    axes.xText = [](float v) {
      return v >= 0 ? std::string("newest") : fmt::format("{} frame{} ago", -v, v == -1 ? "" : "s");
    };
    axes.yText = [](float v) { return withUnit(v); };
    axes.ignoresOutlier = true;
    axes.bridge = 3;  // pictures and relights take turns
    const std::optional<size_t> column = plot({size.x, size.y}, lines, axes);
    if (!column) return std::nullopt;
    return history_.size() - 1 - static_cast<size_t>(-x[*column]);
  }

  /// One frame: GPU by stages, and CPU, on one scale.
  void drawBars(size_t frame) {
    const float gpu = history_.gpuMs(frame), cpu = history_.cpuMs(frame), most = std::max({gpu, cpu, 1e-6f});
    const float label = ImGui::CalcTextSize("GPU 0000.00 ms ").x, height = ImGui::GetTextLineHeight();
    const auto bar = [&](const char* name, float total, auto&& parts, const char* help) {
      const ImVec2 low = ImGui::GetCursorScreenPos();
      ImGui::BeginGroup();  // the tooltip is of the number, too
      const float width = ImGui::GetContentRegionAvail().x - label;
      ImGui::TextColored(theme::dim, "%s %s", name, withUnit(total).c_str());
      ImGui::SameLine(0, 0);
      ImGui::SetCursorScreenPos({low.x + label, low.y});
      ImGui::Dummy({std::max(width, 1.0f), height});
      ImGui::EndGroup();
      helpTooltip(help);
      float x = low.x + label;
      parts([&](float ms, uint32_t color) {
        const float end = x + std::max(0.0f, width) * ms / most;
        ImGui::GetWindowDrawList()->AddRectFilled({x, low.y + 2}, {end, low.y + height - 2}, color);
        x = end;
      });
    };
    const auto byStage = [&](auto&& part) {
      for (size_t s = 0; s < history_.stages().size(); ++s)
        if (const float ms = history_.stages()[s].ms[frame]; !std::isnan(ms)) part(ms, seriesColor(s));
    };
    bar("GPU", gpu, byStage, "GPU time of this frame by stages, in the colours of the list");
    bar(
        "CPU", cpu, [&](auto&& part) { part(cpu, ImGui::GetColorU32(theme::dim)); },
        "CPU time of this frame: a picture's until it is submitted; a relight's until it is done, the GPU's included");
  }

  /// Names and times of one frame; a click shows or hides, a double click shows that one alone.
  void drawStages(ImVec2 size, size_t frame) {
    ImGui::BeginChild("stages", size);
    ImGui::PushStyleVar(ImGuiStyleVar_ItemSpacing, {ImGui::GetStyle().ItemSpacing.x, 1});
    // Stages that ran in the frame come first.
    for (const bool ran : {true, false})
      for (size_t s = 0; s < history_.stages().size(); ++s)
        if (std::isnan(history_.stages()[s].ms[frame]) != ran) drawStage(s, frame);
    ImGui::PopStyleVar();
    ImGui::EndChild();
  }

  void drawStage(size_t s, size_t frame) {
    const float box = ImGui::GetTextLineHeight(), number = ImGui::CalcTextSize("0000.00").x;
    TimingHistory::Stage& stage = history_.stages()[s];
    const ImVec2 at = ImGui::GetCursorScreenPos();
    const float width = ImGui::GetContentRegionAvail().x;
    if (ImGui::Selectable(("##" + stage.name).c_str(), false, ImGuiSelectableFlags_AllowDoubleClick)) {
      stage.shown = !stage.shown;
      if (ImGui::IsMouseDoubleClicked(ImGuiMouseButton_Left))
        for (TimingHistory::Stage& other : history_.stages()) other.shown = &other == &stage;
    }
    const bool ran = !std::isnan(stage.ms[frame]);
    helpTooltip([&] {
      return fmt::format(
          "{}\n{}Click: in the plot or not\nDouble click: this one alone", stage.name,
          ran ? "" : "It did not run in this frame: the time is that of the last one in which it did.\n");
    });
    ImDrawList& list = *ImGui::GetWindowDrawList();
    const ImVec2 low{at.x + 0.2f * box, at.y + 0.2f * box}, high{at.x + 0.8f * box, at.y + 0.8f * box};
    if (stage.shown)
      list.AddRectFilled(low, high, seriesColor(s));
    else
      list.AddRect(low, high, seriesColor(s));
    const ImU32 color = ImGui::GetColorU32(stage.shown ? theme::text : theme::dim);
    list.AddText({at.x + 1.1f * box, at.y}, color, clipped(stage.name, width - number - 1.1f * box).c_str());
    // Where it did not run, what it took the last time, in grey.
    const std::string ms = milliseconds(ran ? stage.ms[frame] : stage.last);
    const float left = at.x + width - ImGui::CalcTextSize(ms.c_str()).x;
    list.AddText({left, at.y}, ran ? color : ImGui::GetColorU32(theme::dim), ms.c_str());
    if (Controls::current())
      ImGui::tellPlace(fmt::format("{}={}", stage.name, ms).c_str(), {left, at.y}, {at.x + width, at.y + box}, ran);
  }

  // ---- Tables ----

  void drawTable(const Session& session) {
    const Timings& timings = session.context.timings;
    const bool stale = timings.recorded() != rowsOf_ || rowsWindow_ != window_;
    if (stale && !paused_ && refresh_.due(session)) {
      rows_.clear();
      for (const TimingHistory::Stage& stage : history_.stages()) {
        std::vector<double> ms = history_.times(stage, window_);
        const bool old = ms.empty();
        if (old) ms.push_back(double{stage.last});
        rows_.push_back({stage.name, statistics(std::move(ms)), old});
      }
      rowsOf_ = timings.recorded();
      rowsWindow_ = window_;
    }
    if (!beginNumberTable("times",
                          {{"stage, GPU ms",
                            "Of every stage its time on the GPU, in the frames looked back on that ran it, ms", true},
                           {"mean", "Mean of the samples, ms"},
                           {"min", "The shortest, ms"},
                           {"max", "The longest, ms"},
                           {"std", "Standard deviation of the samples, ms"},
                           {"p50", "Median: half of the samples took no longer, ms"},
                           {"p95", "95 % of the samples took no longer, ms"},
                           {"p99", "99 % of the samples took no longer, ms"},
                           {"samples", "Frames, of those looked back on, that ran the stage; last: none did"}}))
      return;
    for (const Row& row : rows_) {
      ImGui::PushStyleColor(ImGuiCol_Text, row.old ? theme::dim : theme::text);
      ImGui::TableNextRow();
      ImGui::TableNextColumn();
      clippedText(row.stage, ImGui::GetContentRegionAvail().x);
      ImGui::tellControl(fmt::format("{}={}", row.stage, row.old ? "last" : "frames").c_str());
      if (row.old) helpTooltip("It did not run in the frames looked back on: this is what it took the last time.");
      const TimingStats& s = row.stats;
      for (const double value : {s.mean, s.min, s.max, s.std, s.p50, s.p95, s.p99}) {
        ImGui::TableNextColumn();
        rightText(milliseconds(value));
      }
      ImGui::TableNextColumn();
      rightText(row.old ? std::string("last") : fmt::format("{}", s.samples));
      ImGui::PopStyleColor();
    }
    ImGui::EndTable();
  }

  /// Under a line for each scene and resolution the stages of its set-up.
  void drawOneTime() {
    if (history_.oneTime().empty()) return ImGui::TextColored(theme::dim, "nothing was built yet");
    if (!beginNumberTable(
            "one-time",
            {{"stage, GPU ms", "Of every stage of a build its time on the GPU, by scene and resolution, ms", true},
             {"last", "In the newest build, ms"},
             {"mean", "Mean of all builds, ms"},
             {"min", "The shortest, ms"},
             {"max", "The longest, ms"},
             {"times", "Builds that ran the stage"}}))
      return;
    const std::string* of = nullptr;
    for (const TimingHistory::OneTime& row : history_.oneTime()) {
      if (of == nullptr || *of != row.of) {
        of = &row.of;
        ImGui::TableNextRow();
        ImGui::TableNextColumn();
        ImGui::TextColored(theme::accent, "%s", clipped(row.of, ImGui::GetContentRegionAvail().x).c_str());
        ImGui::tellControl(row.of.c_str());
      }
      const TimingStats s = statistics(row.ms);
      ImGui::TableNextRow();
      ImGui::TableNextColumn();
      clippedText(row.stage, ImGui::GetContentRegionAvail().x);
      ImGui::tellControl(fmt::format("{}={}", row.stage, s.samples).c_str());
      for (const double value : {row.ms.back(), s.mean, s.min, s.max}) {
        ImGui::TableNextColumn();
        rightText(milliseconds(value));
      }
      ImGui::TableNextColumn();
      rightText(fmt::format("{}", s.samples));
    }
    ImGui::EndTable();
  }
};

}  // namespace

std::unique_ptr<Panel> makeTimingsPanel() {
  return std::make_unique<TimingsPanel>();
}

}  // namespace irad
