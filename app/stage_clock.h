// What the stages of a build take, by the clock, from the progress that it tells.
#pragma once

#include <array>
#include <chrono>
#include <optional>

#include "gi/build_cost.h"
#include "gi/pipeline.h"

namespace irad::app {

inline double secondsSince(std::chrono::steady_clock::time_point began) {
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - began).count();
}

/// Seconds by BuildTimes::Part; 0: the part did not run.
using PartSeconds = std::array<double, BuildTimes::kParts>;

/// `before` is asked first, and may be empty.
class StageClock {
 public:
  explicit StageClock(Progress before) : before_(std::move(before)) {}
  /// To be given to what is timed. This has to outlive it.
  Progress progress() {
    return [this](const char* stage, float fraction) {
      turnTo(BuildTimes::partOf(stage));
      return !before_ || before_(stage, fraction);
    };
  }
  /// Ends the stage that runs.
  PartSeconds finish() {
    turnTo({});
    return seconds_;
  }

 private:
  using Clock = std::chrono::steady_clock;
  void turnTo(std::optional<BuildTimes::Part> next) {
    const Clock::time_point now = Clock::now();
    if (part_) seconds_[static_cast<size_t>(*part_)] += std::chrono::duration<double>(now - since_).count();
    since_ = now;
    part_ = next;
  }
  Progress before_;
  std::optional<BuildTimes::Part> part_;
  Clock::time_point since_;
  PartSeconds seconds_{};
};

}  // namespace irad::app
