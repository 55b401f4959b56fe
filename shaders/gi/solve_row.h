// What follows a row's sum in a Jacobi sweep (docs/method.md 1): H = F B, then B' = lambda (M + rho (D + H)), relaxed by
// omega. With SOLVE_GAINS also the next iterate of the gains' answer.
#ifndef IRAD_SOLVE_ROW_H
#define IRAD_SOLVE_ROW_H
#include "gi/solve_watch.h"
#include "shared/solve.h"
IRAD_BEGIN

/// A row's sums, as far as they are wanted: xyz; where it is watched `row`; with SOLVE_GAINS w.
struct RowSum {
  vec4 light;  ///< sum_j F_ij x_j
  float row;   ///< sum_j F_ij
};
IRAD_CONST RowSum NO_SUM = {vec4(0.0f), 0.0f};

/// What is known when a kernel is compiled.
struct SolveWork {
  uint work;       ///< SOLVE_SWEEP, ...
  bool sky;        ///< SolvePush::sky is there
  bool reflected;  ///< likewise
};
IRAD_FN bool watches(SolveWork work) { return work.work == SOLVE_WATCH || work.work == SOLVE_GAINS; }

/// The gains' answer without its 1: v' = a (F v + F 1), a = lambda x the largest albedo of the three channels.
IRAD_FN float nextReach(float before, float a, RowSum sum, IRAD_INOUT(Watch) w) {
  float now = a * (sum.light.w + sum.row);
  bool sound = now >= 0.0f && now < SOLVE_REACH_MAX && before >= 0.0f;  // false for a NaN
  if (!sound) now = 0.0f;
  w.rise = sound ? max(now - before, 0.0f) : SOLVE_REACH_MAX;
  w.fall = sound ? max(before - now, 0.0f) : 0.0f;
  w.reach = sound ? before : 0.0f;
  return now;
}

/// `sum`, in units of `weight`, is the row's. What is to be written to its place in SolvePush::output_ is `out_`.
IRAD_FN Watch finishRow(SolvePush p, FacetArrays f, SolveWork work, uint row, RowSum sum, float weight,
                        IRAD_INOUT(vec4) out_) {
  Watch w = NOTHING;
  sum.light *= weight;
  if (work.work == SOLVE_PRODUCT) {
    out_ = vec4(vec3(sum.light), 0.0f);
    return w;
  }
  vec3 rho = unpackAlbedo(f.albedo.at[row]);
  vec3 source = rho * vec3(p.direct.at[row]);
  if (f.hasEmission != 0u) source += f.emission.at[row];
  // The sky is a source, like D: no row's gain has a part in it. It counts as H, the light that comes with the rays.
  vec3 sky = vec3(0.0f);
  if (work.sky) {
    sky = vec3(p.sky.at[row]);
    source += rho * sky;
  }
  if (work.reflected) source += vec3(p.reflected.at[row]);
  vec3 h = vec3(sum.light);
  // The emitters' share of the row's rays replaced by that of the samples; below 0 by rounding alone.
  if (p.correctionGain != 0.0f) {
    h += p.correctionGain * vec3(p.correction.at[row]);
    h = mix(h, vec3(0.0f), lessThan(h, vec3(0.0f)));  // max() could hide a NaN
  }
  h = mix(h, vec3(0.0f), lessThan(abs(h), vec3(p.flush)));
  vec3 now = p.lambda * (source + rho * h);
  vec4 before = p.input_.at[row];  // all of it: glslang 12 takes a component's address for aligned to 16 bytes
  vec3 old = vec3(before);
  if (p.omega != 1.0f) now = mix(old, now, p.omega);
  now = mix(now, vec3(0.0f), lessThan(abs(now), vec3(p.flush)));
  float reach = before.w;
  sum.row *= weight;
  if (work.work == SOLVE_GAINS) reach = nextReach(reach, p.lambda * largestOf(rho), sum, w);
  if (work.sky) h += sky;
  out_ = vec4(now, reach);
  p.indirect.at[row] = vec4(h, 0.0f);
  if (watches(work)) {
    p.rowSum.at[row] = sum.row;
    watchLight(w, source, h, now);
    w.negative += uint(sum.row < 0.0f);
    if (w.nonFinite == 0u) {
      w.delta = largestOf(abs(now - old));
      w.gain = p.lambda * largestOf(rho) * sum.row;
    }
  }
  return w;
}

IRAD_END
#endif
