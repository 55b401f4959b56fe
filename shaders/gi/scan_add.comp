// Exclusive prefix sum, downward: every element but a block's first (which is already final) gets what precedes its block.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "shared/voxelize.h"
layout(local_size_x = 64) in;
layout(push_constant, scalar) uniform Push { ScanPush push; };

void main() {
  uint i = irad_index();
  if (i >= push.count || i % SCAN_BLOCK == 0u) return;
  push.values.at[i * push.stride] += push.values.at[(i - i % SCAN_BLOCK) * push.stride];
}
