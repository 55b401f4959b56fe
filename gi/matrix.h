// The form-factor matrix (docs/method.md 5).
#pragma once

#include <functional>
#include <vector>

#include "renderer/resources.h"
#include "shaders/shared/matrix.h"

namespace irad {

class Context;
struct FacetList;
struct Field;
struct Settings;

struct MatrixStats {
  uint64_t rays = 0, hits = 0, entries = 0, escaped = 0, invalid = 0;  ///< entries: the sky's bins included
  uint64_t bytesUsed = 0, bytesAllocated = 0;  ///< used: of filled entries (padded: 8 B per hit)
  uint32_t largestRow = 0;
};
/// Where none was built there are no rows, and no buffers.
struct FormFactors {
  MatrixFormat format = MatrixFormat::csr;
  uint32_t rows = 0, rays = 0;
  bool tinted = false;           ///< columns tell which channels panes keep off (gi/matrix_row.glsl)
  std::vector<Buffer> segments;  ///< entries of rowsPerSegment rows each (csr), or of fixed stride (padded)
  Buffer rowStart;               ///< rows: first entry within its segment
  Buffer rowInfo;                ///< rows: entries | ... see shared/matrix.h
  Buffer rowSky;                 ///< rows: entries behind each, bins of the sky; only where rays that escape are kept
  Buffer record;                 ///< one MatrixArrays; from kSegmentTable on, the segments' addresses
  static constexpr uint64_t kSegmentTable = 64;
  MatrixStats stats;
  explicit operator bool() const { return static_cast<bool>(record); }
};
/// The most rays that rows can count which name one of so many facets (format csr; `tinted`: FormFactors).
uint32_t mostRaysOfRows(uint32_t facets, bool tinted);
/// `progress` (0..1) may be empty; it returns false to cancel, upon which a WorkError "cancelled" is thrown.
FormFactors buildMatrix(Context& context, const FacetList& facets, const Field& field, const Settings& settings,
                        const std::function<bool(float)>& progress = {});

}  // namespace irad
