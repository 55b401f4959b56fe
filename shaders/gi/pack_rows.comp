#version 460
#extension GL_GOOGLE_include_directive : require
// "GI BuildMatrix", kernel 3: moves the entries of each row of the chunk to its segment, 32 invocations a row.
#include "shared/constants.h"
#include "shared/matrix_build.h"

layout(local_size_x = 64) in;
layout(constant_id = CONSTANT_SKY) const bool SKY = false;
layout(push_constant, scalar) uniform Push { PackRowsPush p; };

void main() {
  uint row = irad_index() / PACK_WIDTH, me = irad_index() % PACK_WIDTH;
  if (row >= p.rows) return;
  uint start = p.starts.at[row], entries = rowEntries(p.rowInfo.at[p.firstRow + row]);
  if (SKY) entries += p.rowSky.at[p.firstRow + row];
  if (me == 0u) p.rowStart.at[p.firstRow + row] = start;
  for (uint k = me; k < entries; k += PACK_WIDTH) p.segment.at[start + k] = p.entries.at[row * p.rays + k];
}
