#version 460
#extension GL_GOOGLE_include_directive : require
// The yardstick of `irad bench`: a buffer copied by 16-byte loads and stores.
#include "shared/bench.h"

layout(local_size_x = 256) in;
layout(push_constant, scalar) uniform Push {
  CopyPush p;
};

void main() {
  uint i = irad_index();
  if (i < p.count) p.to.at[i] = p.from.at[i];
}
