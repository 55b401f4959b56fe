#include "gi/host_matrix.h"

#include <algorithm>
#include <bit>
#include <cstring>
#include <utility>

#include "gi/matrix.h"
#include "gi/thesis/padded_rows.h"
#include "renderer/base/error.h"
#include "renderer/frame/frame.h"
#include "shaders/shared/constants.h"
#include "shaders/shared/solve.h"
#include "shaders/shared/trace.h"

namespace irad {

namespace {

/// Where a row's words begin within its segment.
size_t firstWord(const MatrixArrays& arrays, MatrixFormat format, uint32_t row, uint32_t rowStart) {
  return format == MatrixFormat::csr ? rowStart : paddedStart(arrays, row);
}
/// How many there are.
size_t wordCount(MatrixFormat format, glm::uvec2 info) {
  return size_t{rowEntries(info)} * (format == MatrixFormat::csr ? 1 : kPaddedWords);
}

HostRow decode(const MatrixArrays& arrays, const FormFactors& matrix, glm::uvec2 info,
               std::span<const uint32_t> words) {
  HostRow row;
  row.invalid = rowInvalid(info);
  row.weight = std::bit_cast<float>(info.y);
  if (matrix.format == MatrixFormat::padded) {
    decodePadded(words, row);
    return row;
  }
  const uint32_t facetBits = arrays.columnBits - (matrix.tinted ? TINT_BITS : 0);
  for (const uint32_t word : words) {
    row.columns.push_back(word & ((1u << facetBits) - 1));
    row.hits.push_back(word >> arrays.columnBits);
    if (matrix.tinted) row.closed.push_back(word >> facetBits & TINT_NONE_LEFT);
  }
  return row;
}

/// Part of a buffer, once the frame has finished.
template <class T>
void readPart(Frame& frame, const Buffer& buffer, size_t first, std::span<T> out) {
  frame.readback(buffer, first * sizeof(T), out.size_bytes(),
                 [out](std::span<const uint8_t> bytes) { std::memcpy(out.data(), bytes.data(), bytes.size()); });
}

}  // namespace

double HostRow::sum() const {
  uint64_t n = 0;
  for (const uint32_t h : hits) n += h;
  return static_cast<double>(n) * weight;
}

void forEachRow(Context& context, const FormFactors& matrix, const std::function<void(uint32_t, const HostRow&)>& f) {
  const MatrixArrays arrays = downloadAs<MatrixArrays>(context, matrix.record).at(0);
  const std::vector<glm::uvec2> info = downloadAs<glm::uvec2>(context, matrix.rowInfo);
  std::vector<uint32_t> starts(matrix.rows), segment;
  if (matrix.format == MatrixFormat::csr) starts = downloadAs<uint32_t>(context, matrix.rowStart);
  uint32_t held = UINT32_MAX;
  for (uint32_t r = 0; r < matrix.rows; ++r) {
    const uint32_t wanted = r >> arrays.segmentShift;
    if (wanted != held) segment = downloadAs<uint32_t>(context, matrix.segments.at(held = wanted));
    const size_t first = firstWord(arrays, matrix.format, r, starts.at(r)), count = wordCount(matrix.format, info[r]);
    IRAD_CHECK_OP(first + count, <=, segment.size());
    f(r, decode(arrays, matrix, info[r], std::span(segment).subspan(first, count)));
  }
}

HostRow readRow(Context& context, const FormFactors& matrix, uint32_t row) {
  IRAD_CHECK_OP(row, <, matrix.rows);
  MatrixArrays arrays{};
  glm::uvec2 info{};
  uint32_t start = 0;
  Frame record = context.beginUntimed();
  readPart(record, matrix.record, 0, std::span(&arrays, 1));
  readPart(record, matrix.rowInfo, row, std::span(&info, 1));
  if (matrix.format == MatrixFormat::csr) readPart(record, matrix.rowStart, row, std::span(&start, 1));
  record.submitAndWait();
  std::vector<uint32_t> words(wordCount(matrix.format, info));
  if (!words.empty()) {
    Frame entries = context.beginUntimed();
    readPart(entries, matrix.segments.at(row >> arrays.segmentShift), firstWord(arrays, matrix.format, row, start),
             std::span(words));
    entries.submitAndWait();
  }
  return decode(arrays, matrix, info, words);
}

std::vector<uint32_t> readColumn(Context& context, const FormFactors& matrix, uint32_t column) {
  IRAD_CHECK_OP(column, <, matrix.rows);
  const Buffer hits(context.device, "hits of a column", Subsystem::Staging, 4ull * matrix.rows);
  Frame frame = context.beginUntimed();
  Pass pass = frame.pass("Matrix column");
  pass.shader("gi/matrix_column.comp")
      .constant(CONSTANT_MATRIX_FORMAT, matrix.format)
      .constant(CONSTANT_TINTED, matrix.tinted)
      .push(MatrixColumnPush{pass.in(matrix.record), pass.out(hits), column, 0})
      .dispatch(matrix.rows);
  frame.submitAndWait();
  std::vector<uint32_t> out = downloadAs<uint32_t>(context, hits);
  out.resize(matrix.rows);
  return out;
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
