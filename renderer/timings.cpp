#include "renderer/timings.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <ostream>

#include <fmt/format.h>

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

void Timings::add(std::string_view stage, double gpuMs) {
  for (auto& [name, ms] : open_)
    if (name == stage) {
      ms += gpuMs;
      return;
    }
  open_.emplace_back(stage, gpuMs);
}

void Timings::endFrame(uint64_t frame, bool setup, double cpuMs) {
  frames_.push_back({frame, setup, cpuMs, std::move(open_)});
  open_.clear();
  ++recorded_;
  if (++kept_[setup] <= window_) return;
  // The oldest of its kind goes: near the front, for set-up work is rare.
  frames_.erase(std::find_if(frames_.begin(), frames_.end(), [&](const FrameSample& f) { return f.setup == setup; }));
  --kept_[setup];
}

void Timings::forget() {
  open_.clear();
}

void Timings::reset() {
  forget();
  frames_.clear();
  kept_ = {};
}

std::vector<Timings::Row> Timings::rows() const {
  std::vector<Row> rows;
  std::vector<std::vector<double>> samples;
  for (const FrameSample& frame : frames_)
    for (const auto& [stage, ms] : frame.stages) {
      size_t i = 0;
      while (i < rows.size() && (rows[i].stage != stage || rows[i].setup != frame.setup)) ++i;
      if (i == rows.size()) {
        rows.push_back({stage, frame.setup, {}});
        samples.emplace_back();
      }
      samples[i].push_back(ms);
    }
  for (size_t i = 0; i < rows.size(); ++i) rows[i].stats = statistics(std::move(samples[i]));
  return rows;
}

void writeCsv(std::ostream& out, const Timings& timings) {
  out << "subsystem,kind,mean_ms,min_ms,max_ms,std_ms,p50_ms,p95_ms,p99_ms,samples\n";
  for (const Timings::Row& row : timings.rows()) {
    const TimingStats& s = row.stats;
    out << fmt::format("{},{},{:.6f},{:.6f},{:.6f},{:.6f},{:.6f},{:.6f},{:.6f},{}\n", row.stage,
                       row.setup ? "setup" : "frame", s.mean, s.min, s.max, s.std, s.p50, s.p95, s.p99, s.samples);
  }
}

}  // namespace irad
