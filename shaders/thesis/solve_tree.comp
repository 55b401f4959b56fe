#version 460
#extension GL_GOOGLE_include_directive : require
// "GI Solve", the baseline kernel of T 5.8: one workgroup of 64 per row, slices of 64 entries, then a tree in shared memory
// with a barrier per level; the first invocation writes.
#include "gi/solve.glsl"

layout(local_size_x = 64) in;
shared vec4 partial[64];

void main() {
  MatrixArrays m = p.matrix.at[0];
  uint row = irad_workgroup();
  if (row >= m.rows) return;
  uint me = gl_LocalInvocationID.x;
  Row r = openRow(m, row);
  vec4 sum = vec4(0.0f);
  for (uint i = me; i < r.count; i += 64u) sum += entryTerm(r, m.columnBits, i);
  partial[me] = sum;
  barrier();
  for (uint width = 32u; width > 0u; width >>= 1) {
    if (me < width) partial[me] += partial[me + width];
    barrier();
  }
  if (me == 0u) {
    Watch w = finishRow(row, partial[0] * r.weight);
    report(w);
  }
}
