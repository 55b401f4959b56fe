#version 460
#extension GL_GOOGLE_include_directive : require
// "GI BuildMatrix", kernel 2: one workgroup per row. Equal columns are counted in a hash table in shared memory, and what
// is left, a third of the rays, is sorted (Batcher 1968): entries column | hits << columnBits, ascending, and behind them
// those of the sky's bins. Integers only: the same on every device.
#include "shared/constants.h"
#include "shared/matrix_build.h"
#include "shared/sky.h"

layout(local_size_x_id = CONSTANT_MERGE_WORKGROUP) in;
layout(constant_id = CONSTANT_SORTED) const uint SORTED = 128u;  ///< power of two >= rays
layout(constant_id = CONSTANT_SKY) const bool SKY = false;
const uint MERGE_HELD = (SORTED + gl_WorkGroupSize.x - 1u) / gl_WorkGroupSize.x;
layout(push_constant, scalar) uniform Push { MergeRowsPush p; };

const uint FREE = TRACE_ESCAPED;
shared uint column[SORTED], count[SORTED];
shared uint places, skyPlaces, found, escaped, invalid, notCast;

/// Counts a hit of `c` in the table.
void add(uint c) {
  uint place = hashUint(c) & (SORTED - 1u);
  for (;;) {
    uint there = atomicCompSwap(column[place], FREE, c);
    if (there == FREE || there == c) break;
    place = (place + 1u) & (SORTED - 1u);
  }
  atomicAdd(count[place], 1u);
}

void main() {
  uint row = irad_workgroup();
  if (row >= p.rows) return;
  uint me = gl_LocalInvocationID.x;
  uint width = gl_WorkGroupSize.x;
  uint base = row * p.rays;
  for (uint i = me; i < SORTED; i += width) {
    column[i] = FREE;
    count[i] = 0u;
  }
  if (me == 0u) places = skyPlaces = found = escaped = invalid = notCast = 0u;
  barrier();
  uint out_ = 0u, lost = 0u, missing = 0u, mine = 0u;
  for (uint i = me; i < p.rays; i += width) {
    uint c = p.hits.at[base + i];
    if (c <= TRACE_LAST_FACET) {
      add(c);
      ++mine;
    }
    if (c == TRACE_ESCAPED) ++out_;
    if (SKY && isSky(c)) {
      add(c);
      ++out_;
    }
    if (c == TRACE_INVALID) ++lost;
    if (c == TRACE_NOT_CAST) ++missing;
  }
  if (mine > 0u) atomicAdd(found, mine);
  if (out_ > 0u) atomicAdd(escaped, out_);
  if (lost > 0u) atomicAdd(invalid, lost);
  if (missing > 0u) atomicAdd(notCast, missing);
  barrier();

  // The table's entries, moved to its front in any order: each invocation holds its own until all have read theirs.
  uint held[MERGE_HELD], hits[MERGE_HELD];
  for (uint k = 0u; k < MERGE_HELD; ++k) {
    uint i = me + k * width;
    held[k] = i < SORTED ? column[i] : FREE;
    hits[k] = i < SORTED ? count[i] : 0u;
  }
  barrier();
  for (uint k = 0u; k < MERGE_HELD; ++k) {
    if (held[k] == FREE) continue;
    uint place = atomicAdd(places, 1u);
    column[place] = held[k];
    count[place] = hits[k];
    if (SKY && held[k] > TRACE_LAST_FACET) atomicAdd(skyPlaces, 1u);
  }
  barrier();
  uint entries = places, sorted = 2u;
  while (sorted < entries) sorted <<= 1;
  for (uint i = entries + me; i < sorted; i += width) column[i] = FREE;
  barrier();
  for (uint size = 2u; size <= sorted; size <<= 1)
    for (uint stride = size >> 1; stride > 0u; stride >>= 1) {
      for (uint pair = me; pair < sorted / 2u; pair += width) {
        uint i = 2u * pair - (pair & (stride - 1u));
        uint a = column[i], b = column[i + stride];
        if ((a > b) == ((i & size) == 0u)) {
          column[i] = b;
          column[i + stride] = a;
          uint hitsOfA = count[i];
          count[i] = count[i + stride];
          count[i + stride] = hitsOfA;
        }
      }
      barrier();
    }
  for (uint i = me; i < entries; i += width) {
    bool bin = SKY && column[i] > TRACE_LAST_FACET;
    p.hits.at[base + i] = bin ? (column[i] - TRACE_SKY) | (count[i] << SKY_BIN_BITS) : column[i] | (count[i] << p.columnBits);
  }

  if (me == 0u) {
    uint cast_ = p.rays - notCast;
    float weight = invalid < cast_ ? 1.0f / float(cast_ - invalid) : 0.0f;
    p.counts.at[row] = entries;
    if (SKY) {
      p.rowSky.at[p.firstRow + row] = skyPlaces;
      entries -= skyPlaces;
    }
    p.rowInfo.at[p.firstRow + row] = uvec2(entries | (invalid << 16), floatBitsToUint(weight));
    atomicAdd(p.sums.at[0].hits, found);
    atomicAdd(p.sums.at[0].escaped, escaped);
    atomicAdd(p.sums.at[0].invalid, invalid);
    if (notCast > 0u) atomicAdd(p.sums.at[0].notCast, notCast);
    atomicMax(p.sums.at[0].largestRow, entries);
  }
}
