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

#endif
