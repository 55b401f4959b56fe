// What invocations have found (gi/solve_watch.h), reduced into a SolveResidual.
#ifndef IRAD_SOLVE_WATCH_GLSL
#define IRAD_SOLVE_WATCH_GLSL
#extension GL_KHR_shader_subgroup_arithmetic : require
#include "gi/solve_watch.h"
#include "shared/solve.h"

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
