// The hazard -> barrier rule as a pure function (unit-tested without a GPU).
#pragma once

#include <volk.h>

#include <cstdint>

namespace irad {

/// How a pass uses a resource: stages and access masks of synchronization2.
struct Use {
  VkPipelineStageFlags2 stages = 0;
  VkAccessFlags2 access = 0;
  bool commutes = false;  ///< atomics whose order does not matter, nor that of their passes (Pass::accumulate)
  bool writes() const;
  bool operator==(const Use&) const = default;
};

/// What is known of a resource's past: the last write, and the reads that have been made visible since.
struct ResourceState {
  Use lastWrite;
  Use readsSince;        ///< union of reads since the last write (each already synchronized with it)
  bool defined = false;  ///< images: transitioned out of UNDEFINED
};

/// The memory dependency that `next` needs after `state`; both sides zero: none. Rules: read after write waits for and
/// makes visible the write, unless an earlier read already did so for these stages; write after read is an execution
/// dependency only; write after write is a full memory dependency, but for atomics that commute, at the same stages:
/// they need nothing, as read after read.
struct Dependency {
  Use source, destination;
  bool needed() const { return source.stages != 0; }
};
Dependency dependency(const ResourceState& state, const Use& next);

/// The state after `next` has been recorded.
ResourceState advance(const ResourceState& state, const Use& next);

}  // namespace irad
