// F from one facet to every other. One invocation per column.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "shared/constants.h"
#include "shared/solve.h"
#include "shared/view.h"

layout(local_size_x = 64) in;
layout(constant_id = CONSTANT_MATRIX_FORMAT) const uint FORMAT = MATRIX_CSR;
layout(push_constant, scalar) uniform Push {
  MatrixRowPush p;
};

#include "gi/matrix_row.glsl"

void main() {
  uint column = irad_index();
  MatrixArrays m = p.matrix.at[0];
  if (column >= m.rows) return;
  Row row = openRow(m, p.row);
  float weight = row.weight;  // of a hit; the same for all of the row
  if (FORMAT == MATRIX_PADDED && row.count > 0u) weight = rowEntry(row, m.columnBits, 0u).weight;
  float f = float(hitsOn(row, m.columnBits, column)) * weight;
  p.factors.at[column] = vec4(vec3(f), 0.0);
}
