// A column of the matrix: the hits of every row on one facet. One invocation per row.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "shared/solve.h"

layout(local_size_x = 64) in;
layout(constant_id = 0) const uint FORMAT = SOLVE_CSR;
layout(push_constant, scalar) uniform Push { MatrixColumnPush p; };

#include "gi/matrix_row.glsl"

void main() {
  uint index = irad_index();
  MatrixArrays m = p.matrix.at[0];
  if (index >= m.rows) return;
  Row row = openRow(m, index);
  uint hits = 0u;
  if (FORMAT == SOLVE_CSR) {
    // Columns ascend: the first that is not below the wanted one.
    uint low = 0u;
    uint high = row.count;
    while (low < high) {
      uint middle = (low + high) >> 1;
      if (rowEntry(row, m.columnBits, middle).column < p.column)
        low = middle + 1u;
      else
        high = middle;
    }
    if (low < row.count) {
      RowEntry entry = rowEntry(row, m.columnBits, low);
      if (entry.column == p.column) hits = uint(entry.weight);
    }
  } else {
    for (uint i = 0u; i < row.count; ++i) hits += uint(rowEntry(row, m.columnBits, i).column == p.column);
  }
  p.hits.at[index] = hits;
}
