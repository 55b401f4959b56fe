#version 460
#extension GL_GOOGLE_include_directive : require
// "GI Solve", one invocation per csr row, for devices that load from memory lane by lane (lavapipe): B comes from an
// image, and the entries two at a time.
#define IRAD_SOLVE_IMAGES
#include "gi/solve.glsl"

layout(local_size_x = 64) in;
layout(buffer_reference, scalar, buffer_reference_align = 8) readonly buffer LongArray { uint64_t at[]; };

Sum rowSums(Row r, uint columnBits) {
  LongArray pairs = LongArray(uint64_t(r.entries));
  uint mask = (1u << columnBits) - 1u;
  uint end = r.start + r.count;
  vec4 sum = vec4(0.0f);
  int hits = 0;
  for (uint pair = r.start >> 1; 2u * pair < end; ++pair) {
    uvec2 e = unpack32(pairs.at[pair]);
    // The first and the last pair may hold a neighbour's entry: it counts 0 hits of column 0.
    if (2u * pair < r.start) e.x = 0u;
    if (2u * pair + 1u >= end) e.y = 0u;
    ivec2 h = ivec2(e >> columnBits);  // signed: AVX2 converts no unsigned integers
    hits += h.x + h.y;
    if (TINTED) {
      uint facetBits = columnBits - TINT_BITS, facets = (1u << facetBits) - 1u;
      sum += inputAt(e.x & facets) * vec4(openChannels((e.x & mask) >> facetBits), 1.0f) * float(h.x);
      sum += inputAt(e.y & facets) * vec4(openChannels((e.y & mask) >> facetBits), 1.0f) * float(h.y);
    } else if (GAINS) {
      sum += inputAt(e.x & mask) * float(h.x);
      sum += inputAt(e.y & mask) * float(h.y);
    } else {
      sum.xyz += inputAt(e.x & mask).xyz * float(h.x);
      sum.xyz += inputAt(e.y & mask).xyz * float(h.y);
    }
  }
  return Sum(sum, float(hits));
}

void main() {
  MatrixArrays m = p.matrix.at[0];
  uint row = irad_index();
  Watch w = NOTHING;
  if (row < m.rows) {
    Row r = openRow(m, row);
    w = finishRow(row, rowSums(r, m.columnBits), r.weight);
  }
  report(w);
}
