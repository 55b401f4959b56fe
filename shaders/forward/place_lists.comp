// "RE Forward" by kernels: each material's list gets its place, after the lists before it, and its dispatch arguments.
// `end` is its beginning until the pixels are written.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "shared/passes.h"

layout(local_size_x = 64) in;
layout(push_constant, scalar) uniform PushBlock {
  PixelListPush push;
};

void main() {
  uint material = irad_index();
  if (material >= push.materials) return;
  uint count = push.lists.at[material].count;
  uint groups = (count + RESOLVE_GROUP - 1u) / RESOLVE_GROUP;
  push.lists.at[material].groups = uvec3(min(groups, RESOLVE_ROW), (groups + RESOLVE_ROW - 1u) / RESOLVE_ROW, 1u);
  push.lists.at[material].end = atomicAdd(push.lists.at[push.materials].end, count);
}
