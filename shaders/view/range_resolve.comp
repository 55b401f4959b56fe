// The range that a view is drawn with, from what view/range_measure.comp found. One workgroup.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "shared/debug_views.h"
#include "shared/view.h"

layout(local_size_x = 256) in;
layout(push_constant, scalar) uniform PushBlock { RangePush push; };

const uint PER_THREAD = RANGE_BINS / 256u;
shared uint sums[256];

/// The bin that holds the value of this rank (0: the smallest).
uint binOfRank(uint rank) {
  uint block = 0u;
  while (block < 255u && rank >= sums[block]) rank -= sums[block++];
  uint bin = block * PER_THREAD;
  while (bin < RANGE_BINS - 1u && rank >= push.bins.at[bin]) rank -= push.bins.at[bin++];
  return bin;
}

void main() {
  uint thread = gl_LocalInvocationIndex;
  if (push.mode == RANGE_PERCENTILE) {
    sums[thread] = 0u;
    for (uint i = 0u; i < PER_THREAD; ++i) sums[thread] += push.bins.at[thread * PER_THREAD + i];
  }
  barrier();
  if (thread != 0u) return;
  ViewRange range = push.range.at[0];
  float least = uintBitsToFloat(range.least), most = uintBitsToFloat(range.most);
  float low = push.low, high = push.high;
  if (push.mode != RANGE_MANUAL) {
    low = high = 0.0;
    if (range.drawn > 0u) {
      low = least;
      high = most;
      if (push.mode == RANGE_PERCENTILE) {
        // The lower bin's lower and the upper bin's upper edge: what lies between is at least the share asked for.
        uint below = uint(float(range.drawn - 1u) * (1.0 - 0.01 * push.percentile));
        uint upTo = range.drawn - 1u - below;
        low = max(least, uintBitsToFloat(binOfRank(below) << RANGE_BIN_SHIFT));
        high = min(most, uintBitsToFloat(((binOfRank(upTo) + 1u) << RANGE_BIN_SHIFT) - 1u));
      }
    }
  }
  if (push.kind == VIEW_KIND_SIGNED) {
    high = max(abs(low), abs(high));
    low = -high;
  }
  if (!viewHasRange(push.kind) && high < 1e-30) high = 0.0;  // the upper edge of the bin that holds 0
  push.range.at[0].low = low;
  push.range.at[0].high = high;
}
