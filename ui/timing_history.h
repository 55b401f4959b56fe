// The times of the last frames, stage by stage, as plots and tables want them.
#pragma once

#include <limits>
#include <string>
#include <vector>

#include "renderer/base/timings.h"

namespace irad {

class TimingHistory {
 public:
  static constexpr size_t kMost = 3000;  ///< frames kept, at least

  struct Stage {
    std::string name;
    std::vector<float> ms;                                 ///< of every frame kept; NaN where it did not run
    float last = std::numeric_limits<float>::quiet_NaN();  ///< when it last ran, however long ago
    bool shown = true;
  };
  /// A stage of the set-up of one scene at one resolution, which happens once in a while: its time by each.
  struct OneTime {
    std::string of, stage;
    std::vector<double> ms;
  };

  /// Takes what was measured since the last call.
  void update(const Timings& timings);

  size_t size() const { return cpuMs_.size(); }
  std::vector<Stage>& stages() { return stages_; }
  float cpuMs(size_t frame) const { return cpuMs_.at(frame); }
  float gpuMs(size_t frame) const;
  /// The last frame that ran the stage, of the last `window`; size() where none did.
  size_t lastWith(const char* stage, size_t window) const;
  /// A stage's times in the last `window` frames.
  std::vector<double> times(const Stage& stage, size_t window) const;
  /// In the order in which they first occurred, but what was set up last is first.
  const std::vector<OneTime>& oneTime() const { return oneTime_; }

  /// The largest value in each of `columns` equal parts of the frames from `first` on; NaN where there is none.
  static std::vector<float> peaks(const std::vector<float>& ms, size_t first, size_t columns);

 private:
  void append(const FrameSample& frame);
  void appendSetup(const FrameSample& setup);
  uint64_t seen_ = 0;
  std::vector<Stage> stages_;
  std::vector<float> cpuMs_;
  std::vector<OneTime> oneTime_;
};

}  // namespace irad
