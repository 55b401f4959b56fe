#version 460
#extension GL_GOOGLE_include_directive : require
// "GI Solve", one invocation per row: for devices whose subgroups are short.
#include "gi/solve.glsl"

layout(local_size_x = 64) in;

void main() {
  MatrixArrays m = p.matrix.at[0];
  uint row = irad_index();
  Watch w = NOTHING;
  if (row < m.rows) {
    Row r = openRow(m, row);
    RowSum sum = NO_SUM;
    for (uint i = 0u; i < r.count; ++i) addEntry(sum, r, m.columnBits, i);
    w = finishRow(row, sum, r.weight);
  }
  report(w);
}
