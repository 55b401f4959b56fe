// The form-factor matrix (METHOD section 5, T 5.4-5.6): F_ij = share of facet i's cosine-weighted rays that first meet
// facet j, kept as integer hit counts (csr) or as one place per hit (padded).
#include <algorithm>
#include <bit>

#include "gi/merge_rows.h"
#include "gi/ray_kernel.h"
#include "renderer/error.h"

namespace irad {
namespace {

constexpr const char* kStage = "GI BuildMatrix";
static_assert(sizeof(MatrixArrays) <= FormFactors::kSegmentTable);

/// Rays in one submission: short enough for watchdogs (and for cancelling), long enough to hide the round trip.
uint64_t raysPerSubmission(const Device& device) {
  return device.isCpu ? uint64_t{1} << 18 : uint64_t{1} << 24;
}

double mebibytes(uint64_t bytes) {
  return static_cast<double>(bytes) / (1024.0 * 1024.0);
}

void report(const std::function<bool(float)>& progress, uint64_t done, uint64_t all) {
  if (progress && !progress(static_cast<float>(static_cast<double>(done) / static_cast<double>(all))))
    throw WorkError("building the matrix: cancelled");
}

void addSums(MatrixStats& stats, const ChunkCounts& sums) {
  stats.hits += sums.hits;
  stats.escaped += sums.escaped;
  stats.invalid += sums.invalid;
  stats.largestRow = std::max(stats.largestRow, sums.largestRow);
}

void writeRecord(Context& context, FormFactors& matrix, const MatrixArrays& arrays) {
  std::vector<std::byte> bytes(FormFactors::kSegmentTable +
                               std::max<size_t>(1, matrix.segments.size()) * sizeof(uint64_t));
  matrix.record = Buffer(context.device, "matrix record", Subsystem::Matrix, bytes.size());
  MatrixArrays written = arrays;
  written.segments = matrix.record.address + FormFactors::kSegmentTable;
  written.rowStart = matrix.rowStart.address;
  written.rowInfo = matrix.rowInfo.address;
  written.rows = matrix.rows;
  std::memcpy(bytes.data(), &written, sizeof(written));
  for (size_t i = 0; i < matrix.segments.size(); ++i)
    std::memcpy(bytes.data() + FormFactors::kSegmentTable + i * sizeof(uint64_t), &matrix.segments[i].address,
                sizeof(uint64_t));
  upload(context, matrix.record, bytes);
}

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
  mergeOnDevice(frame, chunk, hits, counts, build.matrix.rowInfo, sums);
  exclusiveScan(frame, kStage, counts, chunk.rows, total);
  ChunkCounts found{};
  uint32_t entries = 0;
  frame.readback(sums, 0, sizeof(found), [&](std::span<const uint8_t> b) { std::memcpy(&found, b.data(), b.size()); });
  frame.readback(total, 0, 4, [&](std::span<const uint8_t> b) { std::memcpy(&entries, b.data(), b.size()); });
  frame.submitAndWait();
  const Buffer& segment = build.addSegment(chunk, found, entries, entries);
  PackRowsPush pack{};
  pack.entries = hits.address;
  pack.starts = counts.address;
  pack.rowInfo = build.matrix.rowInfo.address;
  pack.rowStart = build.matrix.rowStart.address;
  pack.segment = segment.address;
  pack.firstRow = chunk.firstRow;
  pack.rows = chunk.rows;
  pack.rays = chunk.rays;
  Frame packing = build.context.begin();
  packing.pass(kStage)
      .shader("gi/pack_rows.comp")
      .read(hits, counts, build.matrix.rowInfo)
      .write(segment, build.matrix.rowStart)
      .push(pack)
      .dispatch(uint64_t{chunk.rows} * chunk.rays);
  packing.submit();
}

/// CPU devices: the same by the host in mapped memory.
void mergeAndPackOnHost(CsrBuild& build, Frame frame, const Chunk& chunk, const Buffer& hits) {
  // The device's writes are made visible to the host.
  frame.pass(kStage)
      .declare(hits, {VK_PIPELINE_STAGE_2_HOST_BIT, VK_ACCESS_2_HOST_READ_BIT})
      .record([](VkCommandBuffer) {});
  frame.submitAndWait();
  std::vector<glm::uvec2> info(chunk.rows);
  std::vector<uint32_t> start(chunk.rows);
  ChunkCounts sums{};
  const std::span<uint32_t> mapped(static_cast<uint32_t*>(hits.mapped), uint64_t{chunk.rows} * chunk.rays);
  std::vector<uint32_t> entries = mergeOnHost(chunk, mapped, info, start, sums);
  const auto count = static_cast<uint32_t>(entries.size());
  if (count % 2) entries.push_back(0);  // gi/solve_row.comp reads pairs on such devices
  const Buffer& segment = build.addSegment(chunk, sums, count, entries.size());
  if (!entries.empty()) upload(build.context, segment, std::as_bytes(std::span(entries)));
  upload(build.context, build.matrix.rowInfo, std::as_bytes(std::span(info)), 8ull * chunk.firstRow);
  upload(build.context, build.matrix.rowStart, std::as_bytes(std::span(start)), 4ull * chunk.firstRow);
}

/// csr: each chunk of rows is traced once into a scratch array, and turned into a segment of the exact size.
void buildCsr(Context& context, const FacetList& facets, const Field& field, const MatrixParams& params,
              FormFactors& matrix, const std::function<bool(float)>& progress) {
  const Device& device = context.device;
  const uint32_t rows = matrix.rows, rays = params.rays;
  MatrixArrays arrays{};
  arrays.columnBits = std::max(1, static_cast<int>(std::bit_width(rows - 1)));
  if (uint64_t{rays} >= uint64_t{1} << (32 - arrays.columnBits))
    throw UsageError(fmt::format(
        "matrix.rays = {} with {} facets: a csr entry of 32 bits gives {} bits to the column and {} to the "
        "hit count, which holds at most {}; take fewer rays, a lower voxel.resolution or "
        "matrix.format=padded",
        rays, rows, arrays.columnBits, 32 - arrays.columnBits, (uint64_t{1} << (32 - arrays.columnBits)) - 1));
  arrays.segmentShift = std::clamp(static_cast<int>(std::bit_width(raysPerSubmission(device) / rays)) - 1, 6, 20);
  const uint32_t segmentRows = std::min(rows, 1u << arrays.segmentShift);
  const uint64_t places = uint64_t{segmentRows} * rays;

  matrix.rowStart = Buffer(device, "matrix row starts", Subsystem::Matrix, 4ull * rows);
  Buffer hits(device, "matrix scratch: hits of a chunk", Subsystem::Matrix, 4 * places,
              device.isCpu ? Access::Readback : Access::Device);
  Buffer counts(device, "matrix scratch: row counts", Subsystem::Matrix, 4ull * segmentRows);
  Buffer total(device, "matrix scratch: total", Subsystem::Matrix, 4);
  Buffer sums(device, "matrix scratch: sums", Subsystem::Matrix, sizeof(ChunkCounts));
  const RayKernel kernel = rayKernel(facets, field, params);
  CsrBuild build{context, matrix, rows, arrays.segmentShift};
  for (uint32_t first = 0; first < rows; first += segmentRows) {
    const Chunk chunk{first, std::min(segmentRows, rows - first), rays, arrays.columnBits};
    Frame frame = context.begin();
    traceRows(frame, kernel, params, first, chunk.rows, hits);
    if (device.isCpu)
      mergeAndPackOnHost(build, std::move(frame), chunk, hits);
    else
      mergeAndPackOnDevice(build, std::move(frame), chunk, hits, counts, total, sums);
    report(progress, uint64_t{first} + chunk.rows, rows);
  }
  matrix.stats.bytesUsed = 4 * matrix.stats.entries;
  writeRecord(context, matrix, arrays);
}

/// padded (T Fig. 7): a fixed stride of `rays` places of 8 bytes per row, for a power of two of rows, cleared, then
/// filled by one invocation per row.
void buildPadded(Context& context, const FacetList& facets, const Field& field, const MatrixParams& params,
                 FormFactors& matrix, const std::function<bool(float)>& progress) {
  const Device& device = context.device;
  const uint32_t rows = matrix.rows;
  const uint64_t capacity = std::bit_ceil(rows);
  const uint64_t rowBytes = 8ull * params.rays;
  const std::string what = fmt::format("the padded matrix of {} rows x {} places x 8 B", capacity, params.rays);
  try {
    device.memory().check(Subsystem::Matrix, what, capacity * rowBytes);
  } catch (const DeviceError& error) {
    throw DeviceError(fmt::format("{}; matrix.format=csr keeps only the entries that exist (about {:.0f} MiB at most)",
                                  error.what(), mebibytes(4ull * rows * params.rays)));
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
  const uint32_t slice = device.isCpu ? 64 : params.rays;  // lavapipe's limit of turns: gi/padded_rows.glsl
  const uint64_t chunk = std::clamp<uint64_t>(raysPerSubmission(device) * 4 / params.rays, 64, segmentRows);
  for (uint32_t first = 0; first < rows;) {
    const uint64_t segment = first >> arrays.segmentShift;
    const uint64_t end = std::min<uint64_t>({rows, first + chunk, (segment + 1) << arrays.segmentShift});
    PaddedRowsPush push{};
    push.facets = facets.addresses();
    push.chebyshev = kernel.chebyshev();
    push.segment = matrix.segments[segment].address;
    push.rowInfo = matrix.rowInfo.address;
    push.sums = sums.address;
    push.dims = facets.grid.dims;
    push.jfaMax = field.jfaMax;
    push.firstRow = first;
    push.rows = static_cast<uint32_t>(end - first);
    push.jitter = params.jitter;
    push.seed = params.seed;
    push.segmentRow = static_cast<uint32_t>(first & (segmentRows - 1));
    Frame frame = context.begin();
    frame.pass(kStage).fill(sums, 0);
    for (uint32_t ray = 0; ray < params.rays; ray += slice) {
      push.slice = params.rays | ray << 16;
      Pass pass = frame.pass(kStage);
      kernel.configure(pass, device, "padded_rows")
          .constant(3, slice)
          .write(matrix.segments[segment], matrix.rowInfo, sums)
          .push(push)
          .dispatch(push.rows);
    }
    ChunkCounts found{};
    frame.readback(sums, 0, sizeof(found),
                   [&](std::span<const uint8_t> b) { std::memcpy(&found, b.data(), b.size()); });
    frame.submitAndWait();
    addSums(matrix.stats, found);
    first = static_cast<uint32_t>(end);
    report(progress, first, rows);
  }
  matrix.stats.entries = matrix.stats.hits;
  matrix.stats.bytesUsed = 8 * matrix.stats.hits;
  writeRecord(context, matrix, arrays);
}

}  // namespace

FormFactors buildMatrix(Context& context, const FacetList& facets, const Field& field, const Settings& settings,
                        const std::function<bool(float)>& progress) {
  const MatrixParams& params = settings.matrix.gpu;
  FormFactors matrix;
  matrix.format = settings.matrix.format;
  matrix.rows = facets.count;
  matrix.rays = params.rays;
  matrix.rowInfo = Buffer(context.device, "matrix row info", Subsystem::Matrix, 8ull * facets.count);
  matrix.stats.rays = uint64_t{facets.count} * params.rays;
  if (facets.count == 0) {
    matrix.rowStart = Buffer(context.device, "matrix row starts", Subsystem::Matrix, 0);
    writeRecord(context, matrix, MatrixArrays{});
    return matrix;
  }
  report(progress, 0, 1);
  if (matrix.format == MatrixFormat::csr)
    buildCsr(context, facets, field, params, matrix, progress);
  else
    buildPadded(context, facets, field, params, matrix, progress);
  for (const Buffer& segment : matrix.segments) matrix.stats.bytesAllocated += segment.bytes;
  matrix.stats.bytesAllocated += matrix.rowStart.bytes + matrix.rowInfo.bytes + matrix.record.bytes;
  return matrix;
}

}  // namespace irad
