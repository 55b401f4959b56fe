#include "gi/merge_rows.h"

#include <algorithm>
#include <bit>

#include "shaders/shared/constants.h"
#include "shaders/shared/sky.h"

namespace irad {

void mergeOnDevice(Frame& frame, const Chunk& chunk, const Buffer& hits, const Buffer& counts, const Buffer& rowInfo,
                   const Buffer& sums, const Buffer* rowSky) {
  const Device& device = frame.context().device;
  const uint32_t sorted = std::bit_ceil(std::max(2u, chunk.rays));
  const uint32_t width = device.isCpu ? std::max(8u, device.subgroupSize) : std::clamp(sorted / 4, 32u, 256u);
  frame.pass("GI BuildMatrix").fill(sums, 0);
  Pass pass = frame.pass("GI BuildMatrix");
  MergeRowsPush push{};
  push.hits = pass.out(hits);
  push.counts = pass.out(counts);
  push.rowInfo = pass.out(rowInfo);
  if (rowSky != nullptr) push.rowSky = pass.out(*rowSky);
  push.sums = pass.out(sums);
  push.firstRow = chunk.firstRow;
  push.rows = chunk.rows;
  push.rays = chunk.rays;
  push.columnBits = chunk.columnBits;
  pass.shader("gi/merge_rows.comp")
      .constant(CONSTANT_MERGE_WORKGROUP, width)
      .constant(CONSTANT_SORTED, sorted)
      .constant(CONSTANT_SKY, rowSky != nullptr)
      .push(push)
      .dispatchWorkgroups(chunk.rows);
}

std::vector<uint32_t> mergeOnHost(const Chunk& chunk, std::span<uint32_t> hits, std::span<glm::uvec2> info,
                                  std::span<uint32_t> start, ChunkCounts& sums, std::span<uint32_t> sky) {
  std::vector<uint32_t> entries;
  entries.reserve(uint64_t{chunk.rows} * chunk.rays);
  sums = {};
  for (uint32_t r = 0; r < chunk.rows; ++r) {
    const std::span<uint32_t> row = hits.subspan(uint64_t{r} * chunk.rays, chunk.rays);
    std::sort(row.begin(), row.end());
    const auto end = std::upper_bound(row.begin(), row.end(), TRACE_LAST_FACET),
               left = std::find_if_not(end, row.end(), isSky);
    start[r] = static_cast<uint32_t>(entries.size());
    // Facets, then the sky's bins.
    const auto merge = [&](auto first, auto last, uint32_t from, uint32_t bits) {
      const size_t before = entries.size();
      while (first != last) {
        const auto next = std::find_if(first, last, [column = *first](uint32_t c) { return c != column; });
        entries.push_back((*first - from) | static_cast<uint32_t>(next - first) << bits);
        first = next;
      }
      return static_cast<uint32_t>(entries.size() - before);
    };
    const uint32_t count = merge(row.begin(), end, 0, chunk.columnBits);
    if (!sky.empty()) sky[r] = merge(end, left, TRACE_SKY, SKY_BIN_BITS);
    const auto invalid = static_cast<uint32_t>(std::count(end, row.end(), TRACE_INVALID));
    const auto notCast = static_cast<uint32_t>(std::count(end, row.end(), TRACE_NOT_CAST));
    const uint32_t cast = chunk.rays - notCast;
    const float weight = invalid < cast ? 1.0f / static_cast<float>(cast - invalid) : 0.0f;
    info[r] = {count | invalid << 16, std::bit_cast<uint32_t>(weight)};
    sums.hits += static_cast<uint32_t>(end - row.begin());
    sums.escaped += static_cast<uint32_t>((left - end) + std::count(left, row.end(), TRACE_ESCAPED));
    sums.invalid += invalid;
    sums.notCast += notCast;
    sums.largestRow = std::max(sums.largestRow, count);
  }
  return entries;
}

}  // namespace irad
