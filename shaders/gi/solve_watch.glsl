// What a pass over the facets' light reduces into a SolveResidual: the largest values, and what is no light at all.
#ifndef IRAD_SOLVE_WATCH_GLSL
#define IRAD_SOLVE_WATCH_GLSL
#extension GL_KHR_shader_subgroup_arithmetic : require
#include "shared/solve.h"

/// What a row hands to the reductions.
struct Watch {
  float delta, h, gain, source, rise, fall, reach;
  uint nonFinite, nan, negative;
};
const Watch NOTHING = Watch(0.0f, 0.0f, 0.0f, 0.0f, 0.0f, 0.0f, 0.0f, 0u, 0u, 0u);

uint trues(bvec3 b) { return uint(b.x) + uint(b.y) + uint(b.z); }

float largest(vec3 v) { return max(v.x, max(v.y, v.z)); }

/// What is wrong with a row's new light, and how large it is.
void watchLight(inout Watch w, vec3 source, vec3 h, vec3 radiosity) {
  w.nan = trues(isnan(radiosity));
  w.nonFinite = w.nan + trues(isinf(radiosity));
  w.negative = trues(lessThan(min(min(source, h), radiosity), vec3(0.0f)));
  // A maximum with NaN may be either operand, so what is not finite is counted and left out.
  if (w.nonFinite == 0u) {
    w.h = largest(abs(h));
    w.source = largest(abs(source));
  }
}

/// All invocations of the subgroup that are still here call this once. `gains`: rise, fall and reach, too.
void reduceWatch(Watch w, ResidualArray r, bool gains) {
  float delta = subgroupMax(w.delta);
  float h = subgroupMax(w.h);
  float gain = subgroupMax(w.gain);
  float source = subgroupMax(w.source);
  float rise = gains ? subgroupMax(w.rise) : 0.0f;
  float fall = gains ? subgroupMax(w.fall) : 0.0f;
  float reach = gains ? subgroupMax(w.reach) : 0.0f;
  uint nonFinite = subgroupAdd(w.nonFinite);
  uint nan = subgroupAdd(w.nan);
  uint negative = subgroupAdd(w.negative);
  if (!subgroupElect()) return;
  // Most rows change nothing: look before locking.
  if (floatBitsToUint(delta) > r.at[0].maxDelta) atomicMax(r.at[0].maxDelta, floatBitsToUint(delta));
  if (floatBitsToUint(h) > r.at[0].maxH) atomicMax(r.at[0].maxH, floatBitsToUint(h));
  if (floatBitsToUint(gain) > r.at[0].maxGain) atomicMax(r.at[0].maxGain, floatBitsToUint(gain));
  if (floatBitsToUint(source) > r.at[0].maxSource) atomicMax(r.at[0].maxSource, floatBitsToUint(source));
  if (floatBitsToUint(rise) > r.at[0].maxRise) atomicMax(r.at[0].maxRise, floatBitsToUint(rise));
  if (floatBitsToUint(fall) > r.at[0].maxFall) atomicMax(r.at[0].maxFall, floatBitsToUint(fall));
  if (floatBitsToUint(reach) > r.at[0].maxReach) atomicMax(r.at[0].maxReach, floatBitsToUint(reach));
  if (nonFinite > 0u) atomicAdd(r.at[0].nonFinite, nonFinite);
  if (nan > 0u) atomicAdd(r.at[0].nan, nan);
  if (negative > 0u) atomicAdd(r.at[0].negative, negative);
}

#endif
