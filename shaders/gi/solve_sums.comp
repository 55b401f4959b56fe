#version 460
#extension GL_GOOGLE_include_directive : require
// "GI Solve": sums over the facets after a batch of sweeps, of A H and of the products of the sweeps' residuals. No
// atomics, so that they are the same bits in every run; the host adds up the invocations' shares in double.
#include "shared/constants.h"
#include "shared/solve.h"

layout(constant_id = CONSTANT_SOLVE_VECTORS) const uint VECTORS = SOLVE_VECTORS;  // 0: the mean alone
layout(local_size_x = 64) in;
layout(push_constant, scalar) uniform Push { SolveSumsPush p; };

void main() {
  uint me = irad_index();
  if (me >= p.invocations) return;
  vec4 mean = vec4(0.0f);  // of |H|: what is wrong, and negative, is solved to the same tolerance
  vec4 s00 = vec4(0.0f), s10 = s00, s11 = s00, s20 = s00, s21 = s00, s22 = s00, s30 = s00, s31 = s00, s32 = s00,
       s33 = s00;
  for (uint facet = me; facet < p.count; facet += p.invocations) {
    mean += p.area.at[facet] * vec4(abs(p.indirect.at[facet].xyz), 1.0f);
    if (VECTORS < 2u) continue;
    vec4 x1 = p.x1.at[facet];
    vec4 x2 = p.x2.at[facet];
    vec4 r0 = x1 - p.x0.at[facet];
    vec4 r1 = x2 - x1;
    s00 += r0 * r0;
    s10 += r1 * r0;
    s11 += r1 * r1;
    if (VECTORS < 3u) continue;
    vec4 x3 = p.x3.at[facet];
    vec4 r2 = x3 - x2;
    s20 += r2 * r0;
    s21 += r2 * r1;
    s22 += r2 * r2;
    if (VECTORS < 4u) continue;
    vec4 r3 = p.x4.at[facet] - x3;
    s30 += r3 * r0;
    s31 += r3 * r1;
    s32 += r3 * r2;
    s33 += r3 * r3;
  }
  uint stride = p.invocations;
  p.sums.at[me] = mean;
  if (VECTORS < 2u) return;
  p.sums.at[me + 1u * stride] = s00;
  p.sums.at[me + 2u * stride] = s10;
  p.sums.at[me + 3u * stride] = s11;
  p.sums.at[me + 4u * stride] = s20;
  p.sums.at[me + 5u * stride] = s21;
  p.sums.at[me + 6u * stride] = s22;
  p.sums.at[me + 7u * stride] = s30;
  p.sums.at[me + 8u * stride] = s31;
  p.sums.at[me + 9u * stride] = s32;
  p.sums.at[me + 10u * stride] = s33;
}
