#version 460
#extension GL_GOOGLE_include_directive : require
// "GI BuildMatrix", kernel 3: one invocation per place of the chunk; those that hold an entry move it to its segment.
#include "shared/matrix_build.h"

layout(local_size_x = 64) in;
layout(push_constant, scalar) uniform Push { PackRowsPush p; };

void main() {
  uint place = irad_index();
  if (place >= p.rows * p.rays) return;
  uint row = place / p.rays;
  uint k = place % p.rays;
  uint start = p.starts.at[row];
  if (k == 0u) p.rowStart.at[p.firstRow + row] = start;
  if (k < rowEntries(p.rowInfo.at[p.firstRow + row])) p.segment.at[start + k] = p.entries.at[place];
}
