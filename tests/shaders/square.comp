// out[i] = in[i] * in[i] + add
#version 460
#extension GL_GOOGLE_include_directive : require
#include "shared/types.h"
layout(local_size_x = 64) in;
layout(push_constant, scalar) uniform Push {
  UintArray from;
  UintArray to;
  uint count;
  uint add;
};
void main() {
  const uint i = irad_index();
  if (i >= count) return;
  to.at[i] = from.at[i] * from.at[i] + add;
}
