#version 460
#extension GL_GOOGLE_include_directive : require
// "GI Solve": the sweeps' results mixed (docs/method.md 1, Acceleration), in the place of x_0: what a sweep would make
// of the mix of their inputs, whose residual is therefore known without a product.
#extension GL_KHR_shader_subgroup_arithmetic : require
#include "shared/constants.h"
#include "shared/solve.h"

layout(constant_id = CONSTANT_SOLVE_VECTORS) const uint VECTORS = SOLVE_VECTORS;
layout(local_size_x = 64) in;
layout(push_constant, scalar) uniform Push { ExtrapolatePush p; };

const float ROUNDING = 4.8e-7f;  // of a component of x, several sums included: 8 x 2^-24

void main() {
  uint i = irad_index();
  float residual = 0.0f;
  if (i < p.count) {
    // By differences, which are exact where the x are close: x_n - sum_j (weight_0 + ... + weight_j-1) r_j.
    vec4 before = p.x1.at[i];
    vec4 mixed = p.weight0 * (before - p.x0.at[i]);
    vec4 sum = p.weight0;
    vec4 size = abs(p.weight0);
    vec4 last = p.x2.at[i];
    vec4 r = last - before;
    mixed += p.weight1 * r;
    vec4 step = sum * r;
    sum += p.weight1;
    size += abs(p.weight1);
    if (VECTORS > 2u) {
      before = last;
      last = p.x3.at[i];
      r = last - before;
      mixed += p.weight2 * r;
      step += sum * r;
      sum += p.weight2;
      size += abs(p.weight2);
    }
    if (VECTORS > 3u) {
      before = last;
      last = p.x4.at[i];
      r = last - before;
      mixed += p.weight3 * r;
      step += sum * r;
      size += abs(p.weight3);
    }
    // Light and the gains' answer are not negative: what is put back to 0 comes nearer to them.
    p.x0.at[i] = max(last - step, vec4(0.0f));
    vec3 left = abs(mixed.xyz) + ROUNDING * size.xyz * abs(last.xyz);
    residual = max(left.x, max(left.y, left.z));
  }
  residual = subgroupMax(residual);
  if (subgroupElect() && floatBitsToUint(residual) > p.residual.at[0].maxDelta)
    atomicMax(p.residual.at[0].maxDelta, floatBitsToUint(residual));
}
