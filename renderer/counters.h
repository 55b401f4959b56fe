// What was asked of a device since it was made.
#pragma once

#include <atomic>
#include <cstdint>

namespace irad {

/// Work counts when it is recorded, whether or not an indirect dispatch then finds nothing to do; transfers do not.
struct Counters {
  uint64_t dispatches = 0, draws = 0, submissions = 0;
  uint64_t allocations = 0;          ///< blocks of device memory
  uint64_t buffers = 0, images = 0;  ///< that asked for memory
  uint64_t pipelines = 0;            ///< compiled
  uint64_t exchanges = 0;            ///< submissions and waits

  uint64_t resources() const { return buffers + images; }
  bool operator==(const Counters&) const = default;
  /// What was asked of it since `before`.
  Counters since(const Counters& before) const {
    return {.dispatches = dispatches - before.dispatches,
            .draws = draws - before.draws,
            .submissions = submissions - before.submissions,
            .allocations = allocations - before.allocations,
            .buffers = buffers - before.buffers,
            .images = images - before.images,
            .pipelines = pipelines - before.pipelines,
            .exchanges = exchanges - before.exchanges};
  }
};

/// The same, safe to raise from several threads.
struct LiveCounters {
  std::atomic<uint64_t> dispatches{0}, draws{0}, submissions{0}, allocations{0}, buffers{0}, images{0}, pipelines{0},
      exchanges{0};
  uint64_t resources() const { return buffers + images; }
  Counters now() const {
    return {.dispatches = dispatches,
            .draws = draws,
            .submissions = submissions,
            .allocations = allocations,
            .buffers = buffers,
            .images = images,
            .pipelines = pipelines,
            .exchanges = exchanges};
  }
};

}  // namespace irad
