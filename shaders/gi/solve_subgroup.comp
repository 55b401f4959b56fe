#version 460
#extension GL_GOOGLE_include_directive : require
// "GI Solve", one subgroup per row, whatever its size.
#include "gi/solve.glsl"

layout(local_size_x = 128) in;

void main() {
  MatrixArrays m = p.matrix.at[0];
  uint group = irad_workgroup();
  uint subgroups = gl_NumWorkGroups.x * gl_NumWorkGroups.y * gl_NumSubgroups;
  Watch w = NOTHING;
  for (uint row = group * gl_NumSubgroups + gl_SubgroupID; row < m.rows; row += subgroups) {
    Row r = openRow(m, row);
    RowSum sum = NO_SUM;
    for (uint i = gl_SubgroupInvocationID; i < r.count; i += gl_SubgroupSize) addEntry(sum, r, m.columnBits, i);
    sum.light.xyz = subgroupAdd(sum.light.xyz);
    if (WATCHES) sum.row = subgroupAdd(sum.row);
    if (GAINS) sum.light.w = subgroupAdd(sum.light.w);
    if (subgroupElect()) addWatch(w, finishRow(row, sum, r.weight));
  }
  report(w);
}
