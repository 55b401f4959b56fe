#include "renderer/base/timings.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <ostream>
#include <utility>

#include <fmt/format.h>

#include "renderer/base/csv.h"

namespace irad {

TimingStats statistics(std::vector<double> values) {
  TimingStats s;
  s.samples = values.size();
  if (values.empty()) return s;
  std::sort(values.begin(), values.end());
  const double n = static_cast<double>(values.size());
  // Nearest rank: the smallest value with at least p % of the samples at or below it.
  const auto percentile = [&](double p) {
    const auto rank = static_cast<size_t>(std::ceil(p / 100.0 * n));
    return values[std::clamp<size_t>(rank, 1, values.size()) - 1];
  };
  s.mean = std::accumulate(values.begin(), values.end(), 0.0) / n;
  s.min = values.front();
  s.max = values.back();
  double squares = 0;
  for (const double v : values) squares += (v - s.mean) * (v - s.mean);
  s.std = values.size() > 1 ? std::sqrt(squares / (n - 1)) : 0.0;  // of the sample
  s.p50 = percentile(50);
  s.p95 = percentile(95);
  s.p99 = percentile(99);
  return s;
}

double FrameSample::gpuMs() const {
  double sum = 0;
  for (const auto& [stage, ms] : stages) sum += ms;
  return sum;
}

namespace {
void addTo(std::vector<std::pair<std::string, double>>& stages, std::string_view stage, double ms) {
  for (auto& [name, sum] : stages)
    if (name == stage) {
      sum += ms;
      return;
    }
  stages.emplace_back(stage, ms);
}
}  // namespace

void FrameSample::add(const FrameSample& other) {
  for (const auto& [stage, ms] : other.stages) addTo(stages, stage, ms);
  spans.insert(spans.end(), other.spans.begin(), other.spans.end());
  cpuMs += other.cpuMs;
}

std::vector<StageSamples> stageSamples(const std::deque<FrameSample>& frames, size_t window) {
  size_t skipped = static_cast<size_t>(
      std::count_if(frames.begin(), frames.end(), [](const FrameSample& f) { return f.kind != WorkKind::Setup; }));
  skipped -= std::min(skipped, window);
  std::vector<StageSamples> out;
  for (const FrameSample& frame : frames) {
    if (frame.kind != WorkKind::Setup && skipped > 0) {
      --skipped;
      continue;
    }
    for (const auto& [stage, ms] : frame.stages) {
      auto found = std::find_if(out.begin(), out.end(), [&, &name = stage](const StageSamples& s) {
        return s.kind == frame.kind && s.stage == name;
      });
      if (found == out.end()) found = out.insert(out.end(), {frame.kind, stage, {}});
      found->ms.push_back(ms);
    }
  }
  return out;
}

void Timings::add(std::string_view stage, double gpuMs, std::optional<double> began) {
  constexpr double kPause = 0.05;  // ms; passes farther apart than this are two spans
  if (began) {
    std::vector<FrameSample::Span>& spans = open_.spans;
    const bool goesOn = !spans.empty() && spans.back().stage == stage && *began - spans.back().ended < kPause;
    if (!goesOn) spans.push_back({std::string(stage), *began, *began});
    spans.back().ended = *began + gpuMs;
  }
  addTo(open_.stages, stage, gpuMs);
}

void Timings::endFrame(uint64_t frame, bool setup, double cpuMs, Clock::time_point ended) {
  open_.frame = frame;
  open_.kind = setup ? WorkKind::Setup : WorkKind::Frame;
  if (setup) open_.of = subject_;
  open_.began = std::chrono::duration<double, std::milli>(ended - made_).count() - cpuMs;
  open_.cpuMs = cpuMs;
  frames_.push_back(std::exchange(open_, {}));
  ++recorded_;
  if (++kept_[!setup] <= window_) return;
  // Drops the oldest of its kind, which is near the front, since set-up work is rare.
  frames_.erase(std::find_if(frames_.begin(), frames_.end(),
                             [&](const FrameSample& f) { return (f.kind == WorkKind::Setup) == setup; }));
  --kept_[!setup];
}

void Timings::forget() {
  open_ = {};
}

void Timings::reset() {
  forget();
  frames_.clear();
  kept_ = {};
}

double Timings::now() const {
  return std::chrono::duration<double, std::milli>(Clock::now() - made_).count();
}

std::vector<Timings::Row> Timings::rows() const {
  return timingRows(stageSamples(frames_));
}

std::vector<Timings::Row> timingRows(std::vector<StageSamples> samples) {
  std::vector<Timings::Row> rows;
  for (StageSamples& s : samples) rows.push_back({s.kind, std::move(s.stage), statistics(std::move(s.ms))});
  return rows;
}

void writeCsv(std::ostream& out, const std::vector<Timings::Row>& rows) {
  out << "subsystem,kind,mean_ms,min_ms,max_ms,std_ms,p50_ms,p95_ms,p99_ms,samples\n";
  for (const Timings::Row& row : rows) {
    const TimingStats& s = row.stats;
    out << fmt::format("{},{},{:.6f},{:.6f},{:.6f},{:.6f},{:.6f},{:.6f},{:.6f},{}\n", csvField(row.stage),
                       toString(row.kind), s.mean, s.min, s.max, s.std, s.p50, s.p95, s.p99, s.samples);
  }
}

}  // namespace irad
