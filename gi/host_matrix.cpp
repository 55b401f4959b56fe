#include "gi/host_matrix.h"

#include <algorithm>
#include <bit>
#include <utility>

#include "renderer/error.h"

namespace irad {

double HostRow::sum() const {
  uint64_t n = 0;
  for (const uint32_t h : hits) n += h;
  return static_cast<double>(n) * weight;
}

void forEachRow(Context& context, const FormFactors& matrix, const std::function<void(uint32_t, const HostRow&)>& f) {
  const MatrixArrays arrays = downloadAs<MatrixArrays>(context, matrix.record).at(0);
  const std::vector<glm::uvec2> info = downloadAs<glm::uvec2>(context, matrix.rowInfo);
  const bool csr = matrix.format == MatrixFormat::csr;
  std::vector<uint32_t> starts, segment;
  if (csr) starts = downloadAs<uint32_t>(context, matrix.rowStart);
  uint32_t held = UINT32_MAX;
  for (uint32_t r = 0; r < matrix.rows; ++r) {
    const uint32_t wanted = r >> arrays.segmentShift, within = r & ((1u << arrays.segmentShift) - 1);
    if (wanted != held) segment = downloadAs<uint32_t>(context, matrix.segments.at(held = wanted));
    HostRow row;
    row.invalid = rowInvalid(info[r]);
    row.weight = std::bit_cast<float>(info[r].y);
    for (uint32_t i = 0; i < rowEntries(info[r]); ++i) {
      if (csr) {
        const uint32_t entry = segment.at(size_t{starts.at(r)} + i);
        row.columns.push_back(entry & ((1u << arrays.columnBits) - 1));
        row.hits.push_back(entry >> arrays.columnBits);
      } else {
        const size_t place = 2 * (size_t{within} * arrays.stride + i);
        row.columns.push_back(segment.at(place));
        row.hits.push_back(1);
        IRAD_CHECK_OP(segment.at(place + 1), ==, info[r].y);
      }
    }
    f(r, row);
  }
}

std::vector<HostRow> hostRows(Context& context, const FormFactors& matrix) {
  std::vector<HostRow> rows;
  forEachRow(context, matrix, [&](uint32_t, const HostRow& row) { rows.push_back(row); });
  return rows;
}

HostRow merged(const HostRow& row) {
  std::vector<std::pair<uint32_t, uint32_t>> places;
  for (size_t i = 0; i < row.columns.size(); ++i) places.emplace_back(row.columns[i], row.hits[i]);
  std::sort(places.begin(), places.end());
  HostRow out{{}, {}, row.invalid, row.weight};
  for (const auto& [column, hits] : places) {
    if (!out.columns.empty() && out.columns.back() == column) {
      out.hits.back() += hits;
    } else {
      out.columns.push_back(column);
      out.hits.push_back(hits);
    }
  }
  return out;
}

}  // namespace irad
