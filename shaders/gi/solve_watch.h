// What a pass over the facets' light finds: the largest values, and what is no light at all.
#ifndef IRAD_SOLVE_WATCH_H
#define IRAD_SOLVE_WATCH_H
#include "shared/types.h"
IRAD_BEGIN

/// What a row hands to the reductions into a SolveResidual.
struct Watch {
  float delta, h, gain, source, rise, fall, reach;
  uint nonFinite, nan, negative;
};
IRAD_CONST Watch NOTHING = {0.0f, 0.0f, 0.0f, 0.0f, 0.0f, 0.0f, 0.0f, 0u, 0u, 0u};

IRAD_FN void addWatch(IRAD_INOUT(Watch) w, Watch next) {
  w.delta = max(w.delta, next.delta);
  w.h = max(w.h, next.h);
  w.gain = max(w.gain, next.gain);
  w.source = max(w.source, next.source);
  w.rise = max(w.rise, next.rise);
  w.fall = max(w.fall, next.fall);
  w.reach = max(w.reach, next.reach);
  w.nonFinite += next.nonFinite;
  w.nan += next.nan;
  w.negative += next.negative;
}

IRAD_FN uint trues(bvec3 b) { return uint(b.x) + uint(b.y) + uint(b.z); }

IRAD_FN float largestOf(vec3 v) { return max(v.x, max(v.y, v.z)); }

/// What is wrong with a row's new light, and how large it is.
IRAD_FN void watchLight(IRAD_INOUT(Watch) w, vec3 source, vec3 h, vec3 radiosity) {
  w.nan = trues(isnan(radiosity));
  w.nonFinite = w.nan + trues(isinf(radiosity));
  w.negative = trues(lessThan(min(min(source, h), radiosity), vec3(0.0f)));
  // A maximum with NaN may be either operand, so what is not finite is counted and left out.
  if (w.nonFinite == 0u) {
    w.h = largestOf(abs(h));
    w.source = largestOf(abs(source));
  }
}

IRAD_END
#endif
