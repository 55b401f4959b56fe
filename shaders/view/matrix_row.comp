// F from one facet to every other. One invocation per column.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "shared/solve.h"
#include "shared/view.h"

layout(local_size_x = 64) in;
layout(constant_id = 0) const uint FORMAT = SOLVE_CSR;
layout(push_constant, scalar) uniform Push { MatrixRowPush p; };

#include "gi/matrix_row.glsl"

void main() {
  uint column = irad_index();
  MatrixArrays m = p.matrix.at[0];
  if (column >= m.rows) return;
  float f = float(hitsOn(openRow(m, p.row), m.columnBits, column)) * uintBitsToFloat(m.rowInfo.at[p.row].y);
  p.factors.at[column] = vec4(vec3(f), 0.0);
}
