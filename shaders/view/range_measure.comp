// The values of a view with a range, or the luminances of one of light: smallest, largest, how many, how many that are marked, and their histogram.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "shared/debug_views.h"
#include "shared/emitters.h"
#include "shared/view.h"

layout(local_size_x = 8, local_size_y = 8) in;
layout(set = 0, binding = 0, rgba32f) uniform readonly image2D linearTarget;
layout(push_constant, scalar) uniform PushBlock { RangePush push; };

shared ViewRange group;

void main() {
  if (gl_LocalInvocationIndex == 0u) group = ViewRange(0xFFFFFFFFu, 0u, 0u, 0u, 0u, 0u, 0.0, 0.0);
  barrier();
  if (all(lessThan(gl_GlobalInvocationID.xy, push.size))) {
    vec4 drawn = imageLoad(linearTarget, ivec2(gl_GlobalInvocationID.xy));
    float value = viewHasRange(push.kind) ? drawn.x : luminance(drawn.rgb);
    if (isnan(value)) {
      atomicAdd(group.nan, 1u);
    } else if (isinf(value)) {
      atomicAdd(group.infinite, 1u);
    } else if (value < 0.0 && !viewHasSign(push.kind)) {
      atomicAdd(group.negative, 1u);
    } else if (drawn.a > 0.0) {
      uint bits = floatBitsToUint(abs(value));
      atomicMin(group.least, bits);
      atomicMax(group.most, bits);
      atomicAdd(group.drawn, 1u);
      if (push.mode == RANGE_PERCENTILE) atomicAdd(push.bins.at[bits >> RANGE_BIN_SHIFT], 1u);
    }
  }
  barrier();
  if (gl_LocalInvocationIndex != 0u) return;
  ViewRangeArray range = push.range;
  atomicMin(range.at[0].least, group.least);
  atomicMax(range.at[0].most, group.most);
  atomicAdd(range.at[0].drawn, group.drawn);
  atomicAdd(range.at[0].nan, group.nan);
  atomicAdd(range.at[0].infinite, group.infinite);
  atomicAdd(range.at[0].negative, group.negative);
}
