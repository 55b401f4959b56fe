// A column of the matrix: the hits of every row on one facet. One invocation per row.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "shared/constants.h"
#include "shared/solve.h"

layout(local_size_x = 64) in;
layout(constant_id = CONSTANT_MATRIX_FORMAT) const uint FORMAT = MATRIX_CSR;
layout(push_constant, scalar) uniform Push { MatrixColumnPush p; };

#include "gi/matrix_row.glsl"

void main() {
  uint index = irad_index();
  MatrixArrays m = p.matrix.at[0];
  if (index >= m.rows) return;
  p.hits.at[index] = hitsOn(openRow(m, index), m.columnBits, p.column);
}
