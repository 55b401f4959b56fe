// GPU and CPU milliseconds per stage: samples, statistics (the columns of T Tables 6-10), CSV.
#pragma once

#include <array>
#include <cstdint>
#include <deque>
#include <iosfwd>
#include <string>
#include <string_view>
#include <vector>

namespace irad {

struct TimingStats {
  double mean = 0, min = 0, max = 0, std = 0, p50 = 0, p95 = 0, p99 = 0;  ///< ms; percentiles by nearest rank
  uint64_t samples = 0;
};
TimingStats statistics(std::vector<double> milliseconds);

class Timings {
 public:
  /// Keeps the last `window` groups of per-frame work, and as many of set-up work.
  explicit Timings(size_t window = SIZE_MAX) : window_(window) {}
  /// Adds one pass's time. Passes of the same stage within one sample group (frame) are summed by `endFrame`.
  void add(std::string_view stage, double gpuMs);
  /// Closes the group: each stage seen since the last call gets one sample. `setup`: the group is one-time work (a
  /// rebuild), listed apart from per-frame stages.
  void endFrame(uint64_t frame, bool setup, double cpuMs);
  void forget();  ///< drops what was added since the last group: work that was given up
  void reset();

  struct FrameSample {
    uint64_t frame;
    bool setup;
    double cpuMs;
    std::vector<std::pair<std::string, double>> stages;
  };
  const std::deque<FrameSample>& frames() const { return frames_; }
  uint64_t recorded() const { return recorded_; }  ///< groups ever closed: grows where frames() stays full
  /// Rows in order of first appearance: (stage, setup, statistics).
  struct Row {
    std::string stage;
    bool setup;
    TimingStats stats;
  };
  std::vector<Row> rows() const;

 private:
  size_t window_;
  std::vector<std::pair<std::string, double>> open_;
  std::deque<FrameSample> frames_;
  std::array<size_t, 2> kept_{};  ///< of frames_: per-frame, set-up
  uint64_t recorded_ = 0;
};

/// subsystem,kind,mean_ms,min_ms,max_ms,std_ms,p50_ms,p95_ms,p99_ms,samples
void writeCsv(std::ostream& out, const Timings& timings);

}  // namespace irad
