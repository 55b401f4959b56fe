#include "gi/merge_rows.h"

#include <algorithm>
#include <bit>

#include "shaders/shared/constants.h"

namespace irad {

void mergeOnDevice(Frame& frame, const Chunk& chunk, const Buffer& hits, const Buffer& counts, const Buffer& rowInfo,
                   const Buffer& sums) {
  const Device& device = frame.context().device;
  const uint32_t sorted = std::bit_ceil(std::max(2u, chunk.rays));
  const uint32_t width = device.isCpu ? std::max(8u, device.subgroupSize) : std::clamp(sorted / 4, 32u, 256u);
  frame.pass("GI BuildMatrix").fill(sums, 0);
  Pass pass = frame.pass("GI BuildMatrix");
  MergeRowsPush push{};
  push.hits = pass.out(hits);
  push.counts = pass.out(counts);
  push.rowInfo = pass.out(rowInfo);
  push.sums = pass.out(sums);
  push.firstRow = chunk.firstRow;
  push.rows = chunk.rows;
  push.rays = chunk.rays;
  push.columnBits = chunk.columnBits;
  pass.shader("gi/merge_rows.comp")
      .constant(CONSTANT_MERGE_WORKGROUP, width)
      .constant(CONSTANT_SORTED, sorted)
      .push(push)
      .dispatchWorkgroups(chunk.rows);
}

std::vector<uint32_t> mergeOnHost(const Chunk& chunk, std::span<uint32_t> hits, std::span<glm::uvec2> info,
                                  std::span<uint32_t> start, ChunkCounts& sums) {
  std::vector<uint32_t> entries;
  entries.reserve(uint64_t{chunk.rows} * chunk.rays);
  sums = {};
  for (uint32_t r = 0; r < chunk.rows; ++r) {
    const std::span<uint32_t> row = hits.subspan(uint64_t{r} * chunk.rays, chunk.rays);
    std::sort(row.begin(), row.end());
    const auto end = std::upper_bound(row.begin(), row.end(), TRACE_LAST_FACET);
    start[r] = static_cast<uint32_t>(entries.size());
    for (auto i = row.begin(); i != end;) {
      const auto next = std::find_if(i, end, [column = *i](uint32_t c) { return c != column; });
      entries.push_back(*i | static_cast<uint32_t>(next - i) << chunk.columnBits);
      i = next;
    }
    const auto count = static_cast<uint32_t>(entries.size()) - start[r];
    const auto invalid = static_cast<uint32_t>(std::count(end, row.end(), TRACE_INVALID));
    const auto notCast = static_cast<uint32_t>(std::count(end, row.end(), TRACE_NOT_CAST));
    const uint32_t cast = chunk.rays - notCast;
    const float weight = invalid < cast ? 1.0f / static_cast<float>(cast - invalid) : 0.0f;
    info[r] = {count | invalid << 16, std::bit_cast<uint32_t>(weight)};
    sums.hits += static_cast<uint32_t>(end - row.begin());
    sums.escaped += static_cast<uint32_t>(std::count(end, row.end(), TRACE_ESCAPED));
    sums.invalid += invalid;
    sums.notCast += notCast;
    sums.largestRow = std::max(sums.largestRow, count);
  }
  return entries;
}

}  // namespace irad
