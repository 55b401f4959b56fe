// How often values occur in a picture: of each channel and of the luminance, in bins of one width.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "shared/debug_views.h"
#include "shared/emitters.h"
#include "shared/view.h"

layout(local_size_x = 16, local_size_y = 16) in;
layout(set = 0, binding = 0, rgba32f) uniform readonly image2D linearTarget;
layout(push_constant, scalar) uniform PushBlock { HistogramPush push; };

shared uint counts[HISTOGRAM_COUNTS];
shared uint below, above;

/// The values that the first bin begins and the last one ends with.
vec2 axis() {
  if (push.fixedAxis != 0u) return vec2(push.low, push.high);
  ViewRange values = push.values.at[0];
  float low = viewHasRange(push.kind) ? values.low : 0.0, high = values.high;
  if (uint64_t(push.shown) != 0ul) {  // the ends of the range are in view, too
    ViewRange shown = push.shown.at[0];
    low = min(low, min(shown.low, shown.high));
    high = max(high, max(shown.low, shown.high));
  }
  return vec2(low, high > low ? high : low + max(1e-3 * abs(low), 1e-6));
}

void main() {
  for (uint i = gl_LocalInvocationIndex; i < HISTOGRAM_COUNTS; i += 256u) counts[i] = 0u;
  if (gl_LocalInvocationIndex == 0u) below = above = 0u;
  barrier();
  vec2 ends = axis();
  if (all(lessThan(gl_GlobalInvocationID.xy, push.size))) {
    vec4 drawn = imageLoad(linearTarget, ivec2(gl_GlobalInvocationID.xy));
    bool one = viewHasRange(push.kind);
    vec4 values = one ? drawn.xxxx : vec4(drawn.rgb, luminance(drawn.rgb));
    bool finite = !any(isnan(drawn.rgb)) && !any(isinf(drawn.rgb));
    if (drawn.a > 0.0 && finite) {
      for (uint c = one ? 3u : 0u; c < HISTOGRAM_CHANNELS; ++c) {
        float at = (values[c] - ends.x) / (ends.y - ends.x) * float(HISTOGRAM_BINS);
        if (at >= 0.0 && values[c] <= ends.y)
          atomicAdd(counts[c * HISTOGRAM_BINS + min(uint(at), HISTOGRAM_BINS - 1u)], 1u);
        else if (c == 3u && at < 0.0)
          atomicAdd(below, 1u);
        else if (c == 3u)
          atomicAdd(above, 1u);
      }
    }
  }
  barrier();
  HistogramArray to = push.histogram;
  for (uint i = gl_LocalInvocationIndex; i < HISTOGRAM_COUNTS; i += 256u)
    if (counts[i] > 0u) atomicAdd(to.at[0].counts[i], counts[i]);
  if (gl_LocalInvocationIndex != 0u) return;
  if (below > 0u) atomicAdd(to.at[0].below, below);
  if (above > 0u) atomicAdd(to.at[0].above, above);
  if (gl_WorkGroupID.xy == uvec2(0u)) {
    to.at[0].low = ends.x;
    to.at[0].high = ends.y;
  }
}
