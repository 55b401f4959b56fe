// One Jacobi sweep (docs/method.md 1): H = F B, then B' = lambda (M + rho (D + H)), relaxed by omega. What the three
// kernels share: reading a row's entries, and what follows a row's sum.
// With SOLVE_GAINS it also iterates the gains' answer.
#ifndef IRAD_SOLVE_GLSL
#define IRAD_SOLVE_GLSL
#include "shared/constants.h"
#include "shared/solve.h"

layout(constant_id = CONSTANT_MATRIX_FORMAT) const uint FORMAT = MATRIX_CSR;
layout(constant_id = CONSTANT_SOLVE_WORK) const uint WORK = SOLVE_WATCH;
layout(constant_id = CONSTANT_SKY) const bool SKY = false;
layout(constant_id = CONSTANT_REFLECTED) const bool REFLECTED = false;
layout(push_constant, scalar) uniform Push { SolvePush p; };
const bool GAINS = WORK == SOLVE_GAINS;
const bool WATCHES = WORK == SOLVE_WATCH || GAINS;

#ifdef IRAD_SOLVE_IMAGES
// B also as an image: lavapipe loads from memory lane by lane, but from images all lanes at once.
layout(set = 0, binding = 0, rgba32f) uniform readonly image2D inputImage;
layout(set = 0, binding = 1, rgba32f) uniform writeonly image2D outputImage;
vec4 inputAt(uint j) { return imageLoad(inputImage, solveTexel(j)); }
#else
vec4 inputAt(uint j) { return GAINS ? p.input_.at[j] : vec4(p.input_.at[j].xyz, 0.0f); }
#endif

void putOutput(uint row, vec4 value) {
  p.output_.at[row] = value;
#ifdef IRAD_SOLVE_IMAGES
  imageStore(outputImage, solveTexel(row), value);
#endif
}

#include "gi/matrix_row.glsl"
#include "gi/solve_watch.glsl"

/// A row's sums, as far as they are wanted: xyz; with WATCHES `row`; with GAINS w.
struct Sum {
  vec4 light;  ///< sum_j F_ij x_j
  float row;   ///< sum_j F_ij
};
const Sum NO_SUM = Sum(vec4(0.0f), 0.0f);

/// Adds entry i of the row, in units of the row's weight.
void addEntry(inout Sum sum, Row r, uint columnBits, uint i) {
  RowEntry e = rowEntry(r, columnBits, i);
  if (TINTED) sum.light += inputAt(e.column) * vec4(openChannels(e.closed), 1.0f) * e.weight;
  else sum.light += inputAt(e.column) * e.weight;
  if (WATCHES) sum.row += e.weight;
}

/// The gains' answer without its 1: v' = a (F v + F 1), a = lambda x the largest albedo of the three channels.
float nextReach(float before, float a, Sum sum, inout Watch w) {
  float now = a * (sum.light.w + sum.row);
  bool sound = now >= 0.0f && now < SOLVE_REACH_MAX && before >= 0.0f;  // false for a NaN
  if (!sound) now = 0.0f;
  w.rise = sound ? max(now - before, 0.0f) : SOLVE_REACH_MAX;
  w.fall = sound ? max(before - now, 0.0f) : 0.0f;
  w.reach = sound ? before : 0.0f;
  return now;
}

/// `sum`, in units of `weight`, is the row's.
Watch finishRow(uint row, Sum sum, float weight) {
  Watch w = NOTHING;
  sum.light *= weight;
  if (WORK == SOLVE_PRODUCT) {
    putOutput(row, vec4(sum.light.xyz, 0.0f));
    return w;
  }
  FacetArrays f = p.facets.at[0];
  vec3 rho = unpackAlbedo(f.albedo.at[row]);
  vec3 source = rho * p.direct.at[row].xyz;
  if (f.hasEmission != 0u) source += f.emission.at[row];
  // The sky is a source, like D: no row's gain has a part in it. It counts as H, the light that comes with the rays.
  vec3 sky;
  if (SKY) {
    sky = p.sky.at[row].xyz;
    source += rho * sky;
  }
  if (REFLECTED) source += p.reflected.at[row].xyz;
  vec3 h = sum.light.xyz;
  // The emitters' share of the row's rays replaced by that of the samples; below 0 by rounding alone.
  if (p.correctionGain != 0.0f) {
    h += p.correctionGain * p.correction.at[row].xyz;
    h = mix(h, vec3(0.0f), lessThan(h, vec3(0.0f)));  // max() could hide a NaN
  }
  h = mix(h, vec3(0.0f), lessThan(abs(h), vec3(p.flush)));
  vec3 now = p.lambda * (source + rho * h);
  vec4 before = p.input_.at[row];  // all of it: glslang 12 takes a component's address for aligned to 16 bytes
  vec3 old = before.xyz;
  if (p.omega != 1.0f) now = mix(old, now, p.omega);
  now = mix(now, vec3(0.0f), lessThan(abs(now), vec3(p.flush)));
  float reach = before.w;
  sum.row *= weight;
  if (GAINS) reach = nextReach(reach, p.lambda * largest(rho), sum, w);
  if (SKY) h += sky;
  putOutput(row, vec4(now, reach));
  p.indirect.at[row] = vec4(h, 0.0f);
  if (WATCHES) {
    p.rowSum.at[row] = sum.row;
    watchLight(w, source, h, now);
    w.negative += uint(sum.row < 0.0f);
    if (w.nonFinite == 0u) {
      w.delta = largest(abs(now - old));
      w.gain = p.lambda * largest(rho) * sum.row;
    }
  }
  return w;
}

/// All invocations of the subgroup that are still here call this once.
void report(Watch w) {
  if (WATCHES) reduceWatch(w, p.residual, GAINS);
}

#endif
