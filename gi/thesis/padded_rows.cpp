#include "gi/thesis/padded_rows.h"

#include <algorithm>
#include <bit>

#include "gi/facets.h"
#include "gi/host_matrix.h"
#include "gi/matrix_build.h"
#include "gi/ray_kernel.h"
#include "gi/subsystems.h"
#include "renderer/base/error.h"
#include "renderer/base/number_text.h"
#include "renderer/frame/frame.h"
#include "shaders/shared/constants.h"

namespace irad {

void buildPaddedRows(Context& context, const FacetList& facets, const Field& field, const MatrixParams& params,
                     FormFactors& matrix, const std::function<bool(float)>& progress) {
  const Device& device = context.device;
  const uint32_t rows = matrix.rows;
  const uint64_t capacity = std::bit_ceil(rows);
  const uint64_t rowBytes = 8ull * params.rays;
  const std::string what = fmt::format("the padded matrix of {} rows x {} places x 8 B", capacity, params.rays);
  try {
    device.memory().check(Subsystem::Matrix, what, paddedBytes(rows, params.rays));
  } catch (const DeviceError& error) {
    throw DeviceError(fmt::format("{}; matrix.format=csr keeps only the entries that exist (about {:.0f} MiB at most)",
                                  error.what(), inMebibytes(4ull * rows * params.rays)));
  }
  MatrixArrays arrays{};
  arrays.stride = params.rays;
  // One array, unless the device cannot allocate (or a shader index) that much in one piece.
  const uint64_t largest = std::min<uint64_t>({device.maxAllocation, (uint64_t{1} << 32) - rowBytes, 1ull << 32});
  arrays.segmentShift =
      static_cast<uint32_t>(std::bit_width(std::min(capacity, std::bit_floor(largest / rowBytes)))) - 1;
  const uint64_t segmentRows = uint64_t{1} << arrays.segmentShift;
  matrix.rowStart = Buffer(device, "matrix row starts", Subsystem::Matrix, 0);
  Buffer sums(device, "matrix scratch: sums", Subsystem::Matrix, sizeof(ChunkCounts));
  for (uint64_t first = 0; first < capacity; first += segmentRows)
    matrix.segments.emplace_back(device, fmt::format("matrix places {}", matrix.segments.size()), Subsystem::Matrix,
                                 segmentRows * rowBytes);
  {
    Frame frame = context.begin();
    for (const Buffer& segment : matrix.segments) frame.pass("GI BuildMatrix Clear").fill(segment, 0);
    frame.submit();
  }
  const RayKernel kernel = rayKernel(facets, field, params);
  const uint32_t slice = device.isCpu ? 64 : params.rays;  // lavapipe's limit of turns: thesis/padded_rows.comp
  const uint64_t chunk = std::clamp<uint64_t>(raysPerSubmission(device) * 4 / params.rays, 64, segmentRows);
  for (uint32_t first = 0; first < rows;) {
    const uint64_t segment = first >> arrays.segmentShift;
    const uint64_t end = std::min<uint64_t>({rows, first + chunk, (segment + 1) << arrays.segmentShift});
    PaddedRowsPush push{};
    push.dims = facets.grid.dims;
    push.jfaMax = field.jumpFlood.largest;
    push.firstRow = first;
    push.rows = static_cast<uint32_t>(end - first);
    push.jitter = params.jitter;
    push.seed = params.seed;
    push.segmentRow = static_cast<uint32_t>(first & (segmentRows - 1));
    Frame frame = context.begin();
    frame.pass(kMatrixStage).fill(sums, 0);
    for (uint32_t ray = 0; ray < params.rays; ray += slice) {
      push.slice = params.rays | ray << 16;
      Pass pass = frame.pass(kMatrixStage);
      push.facets = facets.arrays([&](const Buffer& buffer) { return pass.in(buffer); });
      push.chebyshev = kernel.chebyshev(pass);
      push.segment = pass.out(matrix.segments[segment]);
      push.rowInfo = pass.out(matrix.rowInfo);
      push.sums = pass.out(sums);
      kernel.configure(pass, device, "thesis/padded_rows")
          .constant(CONSTANT_SLICE, slice)
          .push(push)
          .dispatch(push.rows);
    }
    ChunkCounts found{};
    frame.readback(sums, 0, sizeof(found),
                   [&](std::span<const uint8_t> b) { std::memcpy(&found, b.data(), b.size()); });
    frame.submitAndWait();
    addSums(matrix.stats, found);
    first = static_cast<uint32_t>(end);
    reportRows(progress, first, rows);
  }
  matrix.stats.entries = matrix.stats.hits;
  matrix.stats.bytesUsed = 8 * matrix.stats.hits;
  writeMatrixRecord(context, matrix, arrays);
}

uint64_t paddedBytes(uint64_t rows, uint64_t rays) {
  return 8 * rays * std::bit_ceil(std::max<uint64_t>(1, rows));
}

size_t paddedStart(const MatrixArrays& arrays, uint32_t row) {
  return kPaddedWords * (row & ((1u << arrays.segmentShift) - 1)) * arrays.stride;
}

void decodePadded(std::span<const uint32_t> words, HostRow& row) {
  for (size_t i = 0; i < words.size(); i += kPaddedWords) {
    row.columns.push_back(words[i]);
    row.hits.push_back(1);
    IRAD_CHECK_OP(words[i + 1], ==, std::bit_cast<uint32_t>(row.weight));
  }
}

}  // namespace irad
