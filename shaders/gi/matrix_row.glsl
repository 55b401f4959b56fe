// Where a matrix row's entries are. The includer declares FORMAT (SOLVE_CSR or SOLVE_PADDED).
#ifndef IRAD_MATRIX_ROW_GLSL
#define IRAD_MATRIX_ROW_GLSL
#include "shared/solve.h"

struct Row {
  UintArray entries;   ///< csr
  Uvec2Array places;   ///< padded
  uint start, count;
  float weight;        ///< of one hit
};

Row openRow(MatrixArrays m, uint row) {
  Row r;
  UintArray segment = m.segments.at[row >> m.segmentShift];
  uvec2 info = m.rowInfo.at[row];
  r.entries = segment;
  r.places = Uvec2Array(uint64_t(segment));
  r.start = FORMAT == SOLVE_CSR ? m.rowStart.at[row] : (row & ((1u << m.segmentShift) - 1u)) * m.stride;
  r.count = rowEntries(info);
  r.weight = FORMAT == SOLVE_CSR ? uintBitsToFloat(info.y) : 1.0f;
  return r;
}

/// Entry i of a row: `weight` in units of the row's weight (csr: its hits).
struct RowEntry {
  uint column;
  float weight;
};

RowEntry rowEntry(Row r, uint columnBits, uint i) {
  if (FORMAT == SOLVE_CSR) {
    uint e = r.entries.at[r.start + i];
    return RowEntry(e & ((1u << columnBits) - 1u), float(e >> columnBits));
  }
  uvec2 place = r.places.at[r.start + i];
  return RowEntry(place.x, uintBitsToFloat(place.y));
}

/// How many of the row's rays met a column.
uint hitsOn(Row row, uint columnBits, uint column) {
  uint hits = 0u;
  if (FORMAT == SOLVE_CSR) {
    // Columns ascend: the first that is not below the wanted one.
    uint low = 0u;
    uint high = row.count;
    while (low < high) {
      uint middle = (low + high) >> 1;
      if (rowEntry(row, columnBits, middle).column < column)
        low = middle + 1u;
      else
        high = middle;
    }
    if (low < row.count) {
      RowEntry entry = rowEntry(row, columnBits, low);
      if (entry.column == column) hits = uint(entry.weight);
    }
  } else {
    for (uint i = 0u; i < row.count; ++i) hits += uint(rowEntry(row, columnBits, i).column == column);
  }
  return hits;
}

#endif
