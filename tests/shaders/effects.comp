// out[i] = i, whichever effects are left out.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "shared/types.h"
layout(local_size_x = 64) in;
layout(constant_id = 0) const bool FIRST = true;
layout(constant_id = 1) const bool SECOND = true;
layout(push_constant, scalar) uniform Push {
  UintArray to;
  uint count;
  uint nothing;
};
void main() {
  const uint i = irad_index();
  if (i >= count) return;
  uint value = i;
  if (FIRST) value += nothing;
  if (SECOND) value += nothing * nothing * i;
  to.at[i] = value;
}
