// GPU and CPU milliseconds per stage: samples, statistics (the columns of T Tables 6-10), CSV.
#pragma once

#include <cstdint>
#include <iosfwd>
#include <map>
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
  /// Adds one pass's time. Passes of the same stage within one sample group (frame) are summed by `endFrame`.
  void add(std::string_view stage, double gpuMs);
  /// Closes the group: each stage seen since the last call gets one sample. `setup`: the group is one-time work (a
  /// rebuild), listed apart from per-frame stages.
  void endFrame(uint64_t frame, bool setup, double cpuMs);
  void reset();

  struct FrameSample {
    uint64_t frame;
    bool setup;
    double cpuMs;
    std::vector<std::pair<std::string, double>> stages;
  };
  const std::vector<FrameSample>& frames() const { return frames_; }
  /// Rows in order of first appearance: (stage, setup, statistics).
  struct Row {
    std::string stage;
    bool setup;
    TimingStats stats;
  };
  std::vector<Row> rows() const;

 private:
  std::vector<std::pair<std::string, double>> open_;
  std::vector<FrameSample> frames_;
};

/// subsystem,kind,mean_ms,min_ms,max_ms,std_ms,p50_ms,p95_ms,p99_ms,samples
void writeCsv(std::ostream& out, const Timings& timings);

}  // namespace irad
