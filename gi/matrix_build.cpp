#include "gi/matrix_build.h"

#include <algorithm>

#include "gi/subsystems.h"
#include "renderer/base/error.h"
#include "renderer/frame/record.h"

namespace irad {

static_assert(sizeof(MatrixArrays) <= FormFactors::kSegmentTable);

uint64_t raysPerSubmission(const Device& device) {
  return device.isCpu ? uint64_t{1} << 18 : uint64_t{1} << 25;
}

void reportRows(const std::function<bool(float)>& progress, uint64_t done, uint64_t all) {
  if (progress && !progress(static_cast<float>(static_cast<double>(done) / static_cast<double>(all))))
    throw WorkError("building the matrix: cancelled");
}

void addSums(MatrixStats& stats, const ChunkCounts& sums) {
  stats.hits += sums.hits;
  stats.escaped += sums.escaped;
  stats.invalid += sums.invalid;
  stats.rays -= sums.notCast;
  stats.largestRow = std::max(stats.largestRow, sums.largestRow);
}

void writeMatrixRecord(Context& context, FormFactors& matrix, const MatrixArrays& arrays) {
  std::vector<std::byte> bytes(FormFactors::kSegmentTable +
                               std::max<size_t>(1, matrix.segments.size()) * sizeof(uint64_t));
  RecordMaker record(context, "matrix record", Subsystem::Matrix, bytes.size());
  MatrixArrays written = arrays;
  written.segments = record.own(FormFactors::kSegmentTable);
  written.rowStart = record.of(matrix.rowStart);
  written.rowInfo = record.of(matrix.rowInfo);
  if (matrix.rowSky) written.rowSky = record.of(matrix.rowSky);
  written.rows = matrix.rows;
  std::memcpy(bytes.data(), &written, sizeof(written));
  for (size_t i = 0; i < matrix.segments.size(); ++i) {
    const uint64_t segment = record.of(matrix.segments[i]);
    std::memcpy(bytes.data() + FormFactors::kSegmentTable + i * sizeof(segment), &segment, sizeof(segment));
  }
  matrix.record = record.make(bytes);
}

}  // namespace irad
