// The form-factor matrix in host memory, row by row: for exports, checks and tests.
#pragma once

#include <functional>
#include <vector>

#include "gi/stages.h"

namespace irad {

/// One row as it is stored: csr holds each column once, ascending; padded holds a place per hit in the rays' order.
struct HostRow {
  std::vector<uint32_t> columns, hits;  ///< hits: rays that met the column; padded: 1 per place
  uint32_t invalid = 0;                 ///< rays that count for nothing
  float weight = 0;                     ///< of one hit: F_ij = hits x weight
  /// sum_j F_ij
  double sum() const;
};

/// Calls f(row index, row) in order; one segment in memory at a time.
void forEachRow(Context& context, const FormFactors& matrix, const std::function<void(uint32_t, const HostRow&)>& f);
std::vector<HostRow> hostRows(Context& context, const FormFactors& matrix);
/// Columns ascending, each once, hits added up.
HostRow merged(const HostRow& row);

}  // namespace irad
