// Where a matrix row's entries are. The includer declares FORMAT: MATRIX_CSR, or MATRIX_PADDED (thesis/padded_row.glsl).
#ifndef IRAD_MATRIX_ROW_GLSL
#define IRAD_MATRIX_ROW_GLSL
#include "gi/tinted.glsl"
#include "shared/solve.h"

struct Row {
  UintArray entries;   ///< csr
  Uvec2Array places;   ///< padded
  uint start, count;
  float weight;        ///< of one hit
};

/// TINTED: a column is a facet and, in the TINT_BITS above its bits, the channels that panes keep off it.
/// Entry i of a row: `weight` in units of the row's weight (csr: its hits).
struct RowEntry {
  uint column;
  float weight;
  uint closed;  ///< TINTED: channels
};

#include "thesis/padded_row.glsl"

Row openRow(MatrixArrays m, uint row) {
  Row r;
  UintArray segment = m.segments.at[row >> m.segmentShift];
  uvec2 info = m.rowInfo.at[row];
  r.entries = segment;
  r.places = Uvec2Array(uint64_t(segment));
  r.start = FORMAT == MATRIX_CSR ? m.rowStart.at[row] : paddedStart(m, row);
  r.count = rowEntries(info);
  r.weight = FORMAT == MATRIX_CSR ? uintBitsToFloat(info.y) : 1.0f;
  return r;
}

RowEntry rowEntry(Row r, uint columnBits, uint i) {
  if (FORMAT != MATRIX_CSR) return paddedEntry(r, i);
  uint e = r.entries.at[r.start + i];
  uint column = e & ((1u << columnBits) - 1u);
  if (!TINTED) return RowEntry(column, float(e >> columnBits), 0u);
  uint facetBits = columnBits - TINT_BITS;
  return RowEntry(column & ((1u << facetBits) - 1u), float(e >> columnBits), column >> facetBits);
}

/// How many of the row's rays met a column; of a tinted one those with these channels closed.
uint hitsOnWith(Row row, uint columnBits, uint column, uint closed) {
  // Columns ascend: the first that is not below the wanted one.
  uint low = 0u;
  uint high = row.count;
  while (low < high) {
    uint middle = (low + high) >> 1;
    RowEntry there = rowEntry(row, columnBits, middle);
    if (there.closed < closed || (there.closed == closed && there.column < column))
      low = middle + 1u;
    else
      high = middle;
  }
  if (low == row.count) return 0u;
  RowEntry entry = rowEntry(row, columnBits, low);
  return entry.column == column && entry.closed == closed ? uint(entry.weight) : 0u;
}
uint hitsOn(Row row, uint columnBits, uint column) {
  if (FORMAT != MATRIX_CSR) return paddedHitsOn(row, column);
  uint hits = hitsOnWith(row, columnBits, column, 0u);
  for (uint closed = 1u; TINTED && closed < TINT_NONE_LEFT; ++closed) hits += hitsOnWith(row, columnBits, column, closed);
  return hits;
}

#endif
