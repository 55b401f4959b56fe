// What the kernels that turn rays into rows take (docs/method.md 5).
#ifndef IRAD_SHARED_MATRIX_BUILD_H
#define IRAD_SHARED_MATRIX_BUILD_H
#include "shared/matrix.h"
#include "shared/trace.h"
IRAD_BEGIN

/// Sums over the rows of a chunk; read back by the host.
struct ChunkCounts {
  uint hits, escaped, invalid, largestRow, notCast;
};
IRAD_ARRAY(ChunkCountsArray, ChunkCounts, 4)

/// gi/merge_rows.comp: sorts what the rays of each row met and merges equal columns, in place.
struct MergeRowsPush {
  UintArray hits;      ///< rows x rays: in, what each ray met; out, the row's entries
  UintArray counts;    ///< rows: entries, later scanned
  Uvec2Array rowInfo;  ///< of all rows
  UintArray rowSky;    ///< of all rows, where there is a sky
  ChunkCountsArray sums;
  uint firstRow, rows, rays, columnBits;
};

/// Invocations that gi/pack_rows.comp has for a row.
IRAD_CONST uint PACK_WIDTH = 32u;
/// gi/pack_rows.comp: moves the entries of a chunk into its exactly sized segment.
struct PackRowsPush {
  UintArray entries;  ///< rows x rays, from merge_rows
  UintArray starts;   ///< rows: exclusive scan of the counts
  Uvec2Array rowInfo;
  UintArray rowSky;  ///< where there is a sky
  UintArray rowStart;
  UintArray segment;
  uint firstRow, rows, rays, pad;
};

/// thesis/padded_rows.comp (T 5.4-5.6): one invocation per row traces and appends.
struct PaddedRowsPush {
  FacetArrays facets;  ///< by value
  ByteArray chebyshev;
  Uvec2Array segment;  ///< of the segment that holds firstRow
  Uvec2Array rowInfo;
  ChunkCountsArray sums;
  uvec3 dims;
  float jfaMax;
  uint firstRow, rows;
  uint slice;  ///< bits 0-15: rays per row; bits 16-31: the first ray of this dispatch
  uint jitter, seed;
  uint segmentRow;  ///< firstRow's place in the segment
};

IRAD_END
#endif
