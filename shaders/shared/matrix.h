// The form-factor matrix on the device (docs/method.md 5).
//   csr:    rows are grouped in segments of 2^segmentShift rows, each segment one exactly sized array of uints. An entry is
//           column | hits << columnBits, columns ascending and merged. Row r lives in segment r >> segmentShift and starts
//           at rowStart[r]. 32-bit offsets and allocation limits hold per segment, whatever the matrix's size.
//           Where there is a sky rowSky[r] entries of another kind lie behind the row's own: the bins of directions into
//           which its rays have escaped (shared/sky.h). Whoever reads rows of facets does not come upon them.
//   padded: T Fig. 7: every row has `stride` places of 8 bytes (column, weight as float bits), one per hit, unmerged; the
//           capacity is a power of two of rows; segments split it only where an allocation would exceed the device's limit.
#ifndef IRAD_SHARED_MATRIX_H
#define IRAD_SHARED_MATRIX_H
#include "shared/enumeration.h"
IRAD_BEGIN

// clang-format off
#define IRAD_MATRIX_FORMATS(X, E) \
  X(E, padded, "padded", MATRIX_PADDED, 0) \
  X(E, csr,    "csr",    MATRIX_CSR,    1)
IRAD_SHARED_ENUM(MatrixFormat, IRAD_MATRIX_FORMATS)
// clang-format on

/// rowInfo[r] = uvec2(entries | invalid << 16, weight bits): weight = 1/(rays - invalid), by which hit counts are
/// scaled.
IRAD_FN uint rowEntries(uvec2 info) { return info.x & 0xFFFFu; }
IRAD_FN uint rowInvalid(uvec2 info) { return info.x >> 16; }

IRAD_ARRAY(SegmentArray, UintArray, 8)

struct MatrixArrays {
  SegmentArray segments;  ///< device addresses, one per segment
  UintArray rowStart;
  Uvec2Array rowInfo;
  uint rows;
  uint segmentShift;
  uint columnBits;  ///< csr
  uint stride;      ///< padded: places per row
  UintArray rowSky;  ///< csr, only where there is a sky
};
IRAD_ARRAY(MatrixRecord, MatrixArrays, 16)

/// gi/matrix_column.comp: how often the rays of each row met one facet.
struct MatrixColumnPush {
  MatrixRecord matrix;
  UintArray hits;  ///< one per row
  uint column;
  uint pad;
};

IRAD_END
#endif
