// The form-factor matrix in host memory, row by row: for exports, checks, the inspector and tests.
#pragma once

#include <cstdint>
#include <functional>
#include <vector>

namespace irad {

class Context;
struct FormFactors;

/// One row as it is stored: csr holds each column once, ascending (of a tinted matrix once for each set of closed
/// channels); padded holds a place per hit in the rays' order.
struct HostRow {
  std::vector<uint32_t> columns, hits;  ///< hits: rays that met the column; padded: 1 per place
  uint32_t invalid = 0;                 ///< rays that count for nothing
  float weight = 0;                     ///< of one hit: F_ij = hits x weight
  /// Of a tinted matrix: the channels that panes have kept off these rays, by place (openChannels() of shared/trace.h).
  std::vector<uint32_t> closed{};
  /// sum_j F_ij
  double sum() const;
};

/// Calls f(row index, row) in order; one segment in memory at a time.
void forEachRow(Context& context, const FormFactors& matrix, const std::function<void(uint32_t, const HostRow&)>& f);
std::vector<HostRow> hostRows(Context& context, const FormFactors& matrix);
/// One row alone.
HostRow readRow(Context& context, const FormFactors& matrix, uint32_t row);
/// Hits on a column in every row: who gathers from that facet. A scan of the rows on the device.
std::vector<uint32_t> readColumn(Context& context, const FormFactors& matrix, uint32_t column);
/// Columns ascending, each once, hits added up, whatever they have kept of their channels.
HostRow merged(const HostRow& row);

}  // namespace irad
