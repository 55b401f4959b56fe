// One Jacobi sweep (docs/method.md 1), what the kernels share: reading a row's entries, and what follows a row's sum.
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

#include "gi/matrix_row.glsl"
#include "gi/solve_row.h"
#include "gi/solve_watch.glsl"

/// Adds entry i of the row, in units of the row's weight.
void addEntry(inout RowSum sum, Row r, uint columnBits, uint i) {
  RowEntry e = rowEntry(r, columnBits, i);
  vec4 x = GAINS ? p.input_.at[e.column] : vec4(p.input_.at[e.column].xyz, 0.0f);
  if (TINTED) sum.light += x * vec4(openChannels(e.closed), 1.0f) * e.weight;
  else sum.light += x * e.weight;
  if (WATCHES) sum.row += e.weight;
}

/// `sum`, in units of `weight`, is the row's.
Watch finishRow(uint row, RowSum sum, float weight) {
  vec4 value;
  Watch w = finishRow(p, p.facets.at[0], SolveWork(WORK, SKY, REFLECTED), row, sum, weight, value);
  p.output_.at[row] = value;
  return w;
}

/// All invocations of the subgroup that are still here call this once.
void report(Watch w) {
  if (WATCHES) reduceWatch(w, p.residual, GAINS);
}

#endif
