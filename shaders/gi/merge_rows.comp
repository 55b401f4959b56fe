#version 460
#extension GL_GOOGLE_include_directive : require
// "GI BuildMatrix", kernel 2: one workgroup per row. Bitonic sort (Batcher 1968) of the columns met in shared memory,
// then equal columns become one entry column | hits << columnBits. Integers only: the order is the same on every device.
#include "shared/constants.h"
#include "shared/matrix_build.h"

layout(local_size_x_id = CONSTANT_MERGE_WORKGROUP) in;
layout(constant_id = CONSTANT_SORTED) const uint SORTED = 128u;  ///< power of two >= rays
layout(push_constant, scalar) uniform Push { MergeRowsPush p; };

shared uint column[SORTED];
shared uint heads[gl_WorkGroupSize.x];
shared uint escapedShared, invalidShared, notCastShared;

void main() {
  uint row = irad_workgroup();
  if (row >= p.rows) return;
  uint me = gl_LocalInvocationID.x;
  uint width = gl_WorkGroupSize.x;
  uint base = row * p.rays;
  for (uint i = me; i < SORTED; i += width) column[i] = i < p.rays ? p.hits.at[base + i] : TRACE_ESCAPED;
  if (me == 0u) escapedShared = invalidShared = notCastShared = 0u;
  barrier();

  for (uint size = 2u; size <= SORTED; size <<= 1)
    for (uint stride = size >> 1; stride > 0u; stride >>= 1) {
      for (uint pair = me; pair < SORTED / 2u; pair += width) {
        uint i = 2u * pair - (pair & (stride - 1u));
        uint a = column[i];
        uint b = column[i + stride];
        bool ascending = (i & size) == 0u;
        column[i] = ascending ? min(a, b) : max(a, b);
        column[i + stride] = ascending ? max(a, b) : min(a, b);
      }
      barrier();
    }

  // Each invocation owns a run of the sorted row: counts its heads, then knows where they go.
  uint run = (SORTED + width - 1u) / width;
  uint from = min(me * run, SORTED);
  uint to = min(from + run, SORTED);
  uint mine = 0u, escaped = 0u, invalid = 0u, notCast = 0u;
  for (uint i = from; i < to; ++i) {
    uint c = column[i];
    if (c <= TRACE_LAST_FACET && (i == 0u || column[i - 1u] != c)) ++mine;
    if (c == TRACE_INVALID) ++invalid;
    if (c == TRACE_ESCAPED) ++escaped;
    if (c == TRACE_NOT_CAST) ++notCast;
  }
  heads[me] = mine;
  if (escaped > 0u) atomicAdd(escapedShared, escaped);
  if (invalid > 0u) atomicAdd(invalidShared, invalid);
  if (notCast > 0u) atomicAdd(notCastShared, notCast);
  barrier();
  uint place = 0u, entries = 0u;
  for (uint i = 0u; i < width; ++i) {
    if (i < me) place += heads[i];
    entries += heads[i];
  }
  for (uint i = from; i < to; ++i) {
    uint c = column[i];
    if (c > TRACE_LAST_FACET || (i > 0u && column[i - 1u] == c)) continue;
    uint end = i + 1u;
    while (end < SORTED && column[end] == c) ++end;
    p.hits.at[base + place] = c | ((end - i) << p.columnBits);
    ++place;
  }
  if (me == 0u) {
    uint lost = invalidShared;
    uint out_ = escapedShared - (SORTED - p.rays);  // without the padding of the sort
    uint first = 0u, last = SORTED;                 // hits = facets in the row: they come first
    while (first < last) {
      uint middle = (first + last) / 2u;
      if (column[middle] <= TRACE_LAST_FACET) first = middle + 1u;
      else last = middle;
    }
    p.counts.at[row] = entries;
    uint cast_ = p.rays - notCastShared;
    float weight = lost < cast_ ? 1.0f / float(cast_ - lost) : 0.0f;
    p.rowInfo.at[p.firstRow + row] = uvec2(entries | (lost << 16), floatBitsToUint(weight));
    atomicAdd(p.sums.at[0].hits, first);
    atomicAdd(p.sums.at[0].escaped, out_);
    atomicAdd(p.sums.at[0].invalid, lost);
    if (cast_ < p.rays) atomicAdd(p.sums.at[0].notCast, p.rays - cast_);
    atomicMax(p.sums.at[0].largestRow, entries);
  }
}
