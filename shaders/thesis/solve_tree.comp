#version 460
#extension GL_GOOGLE_include_directive : require
// "GI Solve", the baseline kernel of T 5.8: one workgroup of 64 per row, slices of 64 entries, then a tree in shared memory
// with a barrier per level; the first invocation writes. SOLVE_GAINS is left to the other kernels.
#include "gi/solve.glsl"

layout(local_size_x = 64) in;
shared vec4 partial[64];  // xyz, and the row's sum of F

void main() {
  MatrixArrays m = p.matrix.at[0];
  uint row = irad_workgroup();
  if (row >= m.rows) return;
  uint me = gl_LocalInvocationID.x;
  Row r = openRow(m, row);
  RowSum sum = NO_SUM;
  for (uint i = me; i < r.count; i += 64u) addEntry(sum, r, m.columnBits, i);
  partial[me] = vec4(sum.light.xyz, sum.row);
  barrier();
  for (uint width = 32u; width > 0u; width >>= 1) {
    if (me < width) partial[me] += partial[me + width];
    barrier();
  }
  if (me == 0u) {
    Watch w = finishRow(row, RowSum(vec4(partial[0].xyz, 0.0f), partial[0].w), r.weight);
    report(w);
  }
}
