// The form-factor matrix (docs/method.md 5, T 5.4-5.6): F_ij = share of facet i's cosine-weighted rays that first meet
// facet j, kept as integer hit counts (csr) or as one place per hit (padded).
#include "gi/matrix.h"

#include <algorithm>
#include <bit>

#include "gi/facets.h"
#include "gi/hits_on_host.h"
#include "gi/host_trace.h"
#include "gi/matrix_build.h"
#include "gi/merge_rows.h"
#include "gi/ray_kernel.h"
#include "gi/scan.h"
#include "gi/settings.h"
#include "gi/subsystems.h"
#include "gi/thesis/padded_rows.h"
#include "renderer/base/error.h"
#include "shaders/shared/constants.h"

namespace irad {
namespace {

/// What both ways to turn a chunk's hits into its segment share.
struct CsrBuild {
  Context& context;
  FormFactors& matrix;
  uint32_t rows, segmentShift;

  /// Makes room for a chunk's entries. From the first chunk on the whole is known well enough to stop before memory
  /// runs out half-way.
  Buffer& addSegment(const Chunk& chunk, const ChunkCounts& sums, uint32_t entries, uint64_t words) {
    addSums(matrix.stats, sums);
    matrix.stats.entries += entries;
    const uint32_t done = chunk.firstRow + chunk.rows;
    const uint64_t expected =
        static_cast<uint64_t>(4.0 * static_cast<double>(matrix.stats.entries) / done * (rows - chunk.firstRow));
    context.device.memory().check(Subsystem::Matrix, fmt::format("csr entries of rows {} to {}", chunk.firstRow, rows),
                                  expected);
    return matrix.segments.emplace_back(
        context.device, fmt::format("matrix entries {}", chunk.firstRow >> segmentShift), Subsystem::Matrix, 4 * words);
  }
};

/// GPUs: sorted and merged where they are, counted, scanned, packed.
void mergeAndPackOnDevice(CsrBuild& build, Frame frame, const Chunk& chunk, const Buffer& hits, const Buffer& counts,
                          const Buffer& total, const Buffer& sums) {
  const Buffer& rowSky = build.matrix.rowSky;
  mergeOnDevice(frame, chunk, hits, counts, build.matrix.rowInfo, sums, rowSky ? &rowSky : nullptr);
  exclusiveScan(frame, kMatrixStage, counts, chunk.rows, total);
  ChunkCounts found{};
  uint32_t entries = 0;
  frame.readback(sums, 0, sizeof(found), [&](std::span<const uint8_t> b) { std::memcpy(&found, b.data(), b.size()); });
  frame.readback(total, 0, 4, [&](std::span<const uint8_t> b) { std::memcpy(&entries, b.data(), b.size()); });
  frame.submitAndWait();
  const Buffer& segment = build.addSegment(chunk, found, entries, entries);
  Frame packing = build.context.begin();
  Pass pass = packing.pass(kMatrixStage);
  PackRowsPush pack{};
  pack.entries = pass.in(hits);
  pack.starts = pass.in(counts);
  pack.rowInfo = pass.in(build.matrix.rowInfo);
  pack.rowSky = pass.inIfAny(rowSky);
  pack.rowStart = pass.out(build.matrix.rowStart);
  pack.segment = pass.out(segment);
  pack.firstRow = chunk.firstRow;
  pack.rows = chunk.rows;
  pack.rays = chunk.rays;
  pass.shader("gi/pack_rows.comp")
      .constant(CONSTANT_SKY, static_cast<bool>(rowSky))
      .push(pack)
      .dispatch(uint64_t{chunk.rows} * PACK_WIDTH);
  packing.submit();
}

/// CPU devices: the same by the host in mapped memory.
void mergeAndPackOnHost(CsrBuild& build, const Chunk& chunk, const Buffer& hits) {
  std::vector<glm::uvec2> info(chunk.rows);
  std::vector<uint32_t> start(chunk.rows), sky(build.matrix.rowSky ? chunk.rows : 0);
  ChunkCounts sums{};
  const std::span<uint32_t> mapped(static_cast<uint32_t*>(hits.mapped), uint64_t{chunk.rows} * chunk.rays);
  std::vector<uint32_t> entries = mergeOnHost(chunk, mapped, info, start, sums, sky);
  const auto count = static_cast<uint32_t>(entries.size());
  if (count % 2) entries.push_back(0);  // gi/solve_row.comp reads pairs on such devices
  const Buffer& segment = build.addSegment(chunk, sums, count, entries.size());
  if (!entries.empty()) upload(build.context, segment, std::as_bytes(std::span(entries)));
  upload(build.context, build.matrix.rowInfo, std::as_bytes(std::span(info)), 8ull * chunk.firstRow);
  upload(build.context, build.matrix.rowStart, std::as_bytes(std::span(start)), 4ull * chunk.firstRow);
  if (!sky.empty()) upload(build.context, build.matrix.rowSky, std::as_bytes(std::span(sky)), 4ull * chunk.firstRow);
}

/// Rays whose hits, and lists of those that wait, are in memory at a time. Each chunk ends with some slow rays, beside
/// which no others run: the larger, the better, within a sixteenth of the device's memory.
uint64_t raysPerChunk(const Device& device) {
  if (device.isCpu) return raysPerSubmission(device);
  const uint64_t rays = device.memory().budget() / 16 / (sizeof(uint32_t) + kWaitingBytes);
  return std::clamp(rays, uint64_t{1} << 23, uint64_t{1} << 26);
}

uint32_t facetBitsOf(uint32_t facets) {
  return std::max(1, static_cast<int>(std::bit_width(std::max(facets, 1u) - 1)));
}
uint32_t columnBitsOf(uint32_t facets, bool tinted) {
  return facetBitsOf(facets) + (tinted ? TINT_BITS : 0);
}

/// csr: each chunk of rows is traced once into a scratch array, and turned into a segment of the exact size. `sky`:
/// rays that escape are kept by bins.
void buildCsr(Context& context, const FacetList& facets, const Field& field, const MatrixParams& params, bool sky,
              FormFactors& matrix, const std::function<bool(float)>& progress) {
  const Device& device = context.device;
  const uint32_t rows = matrix.rows, rays = params.rays;
  MatrixArrays arrays{};
  const uint32_t facetBits = facetBitsOf(rows);
  arrays.columnBits = columnBitsOf(rows, matrix.tinted);
  if (rays > mostRaysOfRows(rows, matrix.tinted))
    throw UsageError(
        fmt::format("matrix.rays = {} with {} facets: a csr entry of 32 bits gives {} bits to the column and {} to the "
                    "hit count, which holds at most {}; take fewer rays, a lower voxel.resolution or "
                    "matrix.format=padded",
                    rays, rows, arrays.columnBits, 32 - arrays.columnBits, mostRaysOfRows(rows, matrix.tinted)));
  arrays.segmentShift = std::clamp(static_cast<int>(std::bit_width(raysPerChunk(device) / rays)) - 1, 6, 20);
  const uint32_t segmentRows = std::min(rows, 1u << arrays.segmentShift);
  const uint64_t places = uint64_t{segmentRows} * rays;

  matrix.rowStart = Buffer(device, "matrix row starts", Subsystem::Matrix, 4ull * rows);
  if (sky) matrix.rowSky = Buffer(device, "matrix rows' bins of the sky", Subsystem::Matrix, 4ull * rows);
  Buffer hits(device, "matrix scratch: hits of a chunk", Subsystem::Matrix, 4 * places,
              device.isCpu ? Access::Readback : Access::Device);
  Buffer counts(device, "matrix scratch: row counts", Subsystem::Matrix, 4ull * segmentRows);
  Buffer total(device, "matrix scratch: total", Subsystem::Matrix, 4);
  Buffer sums(device, "matrix scratch: sums", Subsystem::Matrix, sizeof(ChunkCounts));
  RayKernel kernel = rayKernel(facets, field, params);
  if (matrix.tinted) kernel.tintShift = facetBits;
  const WaitingLists waiting = raysWait(device, kernel) ? makeWaitingLists(device, places) : WaitingLists{};
  CsrBuild build{context, matrix, rows, arrays.segmentShift};
  const HostTrace* host = hostTraceIfAny(context, facets, params, kMatrixStage);
  for (uint32_t first = 0; first < rows; first += segmentRows) {
    const Chunk chunk{first, std::min(segmentRows, rows - first), rays, arrays.columnBits};
    if (device.isCpu) {
      traceMapped(context, kernel, host, params, first, chunk.rows, hits, sky, kMatrixStage);
      mergeAndPackOnHost(build, chunk, hits);
    } else {
      Frame frame = context.begin();
      traceRows(frame, kernel, params, first, chunk.rows, hits, sky, kMatrixStage, waiting);
      mergeAndPackOnDevice(build, std::move(frame), chunk, hits, counts, total, sums);
    }
    reportRows(progress, uint64_t{first} + chunk.rows, rows);
  }
  matrix.stats.bytesUsed = 4 * matrix.stats.entries;
  writeMatrixRecord(context, matrix, arrays);
}

}  // namespace

uint32_t mostRaysOfRows(uint32_t facets, bool tinted) {
  return static_cast<uint32_t>((uint64_t{1} << (32 - columnBitsOf(facets, tinted))) - 1);
}

FormFactors buildMatrix(Context& context, const FacetList& facets, const Field& field, const Settings& settings,
                        const std::function<bool(float)>& progress) {
  const MatrixParams& params = settings.matrix.gpu;
  FormFactors matrix;
  matrix.format = settings.matrix.format;
  matrix.rows = facets.count;
  matrix.rays = params.rays;
  matrix.tinted = facets.surface.tinted;
  if (matrix.tinted && matrix.format == MatrixFormat::padded)
    throw UsageError(
        "matrix.format = padded: its rows cannot tell what panes of KHR_materials_transmission tint; take csr");
  matrix.rowInfo = Buffer(context.device, "matrix row info", Subsystem::Matrix, 8ull * facets.count);
  matrix.stats.rays = uint64_t{facets.count} * params.rays;
  if (facets.count == 0) {
    matrix.rowStart = Buffer(context.device, "matrix row starts", Subsystem::Matrix, 0);
    writeMatrixRecord(context, matrix, MatrixArrays{});
    return matrix;
  }
  reportRows(progress, 0, 1);
  if (matrix.format == MatrixFormat::csr)
    buildCsr(context, facets, field, params, settings.effects.sky == EffectMode::on, matrix, progress);
  else
    buildPaddedRows(context, facets, field, params, matrix, progress);
  for (const Buffer& segment : matrix.segments) matrix.stats.bytesAllocated += segment.bytes;
  matrix.stats.bytesAllocated +=
      matrix.rowStart.bytes + matrix.rowInfo.bytes + matrix.rowSky.bytes + matrix.record.bytes;
  return matrix;
}

}  // namespace irad
