// Counts how often each index occurs; the workgroup's size is specialization constant 0.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "shared/types.h"
layout(local_size_x_id = 0) in;
layout(push_constant, scalar) uniform Push {
  UintArray hits;
  uint count;
};
void main() {
  const uint i = irad_index();
  if (i >= count) return;
  atomicAdd(hits.at[i], 1u);
}
