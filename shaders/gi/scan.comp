// Exclusive prefix sum, one level: each workgroup scans a block of SCAN_BLOCK elements in place. The first element of a
// scanned block would be 0; it keeps the block's sum instead, which makes these first elements the next level's input
// (stride x SCAN_BLOCK) without any scratch memory. gi/scan_add.comp resolves the levels from the top down.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "shared/voxelize.h"
layout(local_size_x = 64) in;
layout(push_constant, scalar) uniform Push { ScanPush push; };

const uint PER_THREAD = SCAN_BLOCK / 64u;
shared uint sums[64];

void main() {
  uint block = irad_workgroup();
  uint thread = gl_LocalInvocationIndex;
  uint first = block * SCAN_BLOCK + thread * PER_THREAD;
  uint end = min(first + PER_THREAD, push.count);
  uint sum = 0u;
  for (uint i = first; i < end; ++i) sum += push.values.at[i * push.stride];
  // Inclusive scan of the threads' sums (Hillis and Steele 1986).
  sums[thread] = sum;
  barrier();
  for (uint step = 1u; step < 64u; step *= 2u) {
    uint below = thread >= step ? sums[thread - step] : 0u;
    barrier();
    sums[thread] += below;
    barrier();
  }
  uint running = sums[thread] - sum;
  for (uint i = first; i < end; ++i) {
    uint value = push.values.at[i * push.stride];
    push.values.at[i * push.stride] = running;
    running += value;
  }
  if (thread == 0u && first < push.count) {
    uint total = sums[63];
    if (push.last != 0u) push.total.at[0] = total;
    else push.values.at[first * push.stride] = total;
  }
}
