#include "gi/sweep_on_host.h"

#include <algorithm>
#include <bit>
#include <vector>

#include "renderer/base/parallel.h"
#include "shaders/shared/trace.h"

namespace irad {
namespace {

/// Rows that a thread takes at once.
constexpr uint32_t kRowBlock = 1024;

template <bool kTinted>
RowSum sumOfRow(const SolvePush& push, const MatrixArrays& matrix, uint32_t row, uint32_t entries) {
  const uint32_t* entry = matrix.segments.at[row >> matrix.segmentShift].at + matrix.rowStart.at[row];
  const uint32_t facetBits = matrix.columnBits - (kTinted ? TINT_BITS : 0), facets = (1u << facetBits) - 1;
  glm::vec4 sum(0);
  uint32_t hits = 0;
  for (const uint32_t* const end = entry + entries; entry != end; ++entry) {
    const uint32_t h = *entry >> matrix.columnBits;
    hits += h;
    glm::vec4 x = push.input_.at[*entry & facets];
    if constexpr (kTinted) x *= glm::vec4(openChannels(*entry >> facetBits & TINT_NONE_LEFT), 1.0f);
    sum += x * static_cast<float>(static_cast<int32_t>(h));
  }
  return {sum, static_cast<float>(hits)};
}

void raise(uint32_t& bits, float value) {
  bits = std::bit_cast<uint32_t>(std::max(std::bit_cast<float>(bits), value));
}

/// reduceWatch(), shaders/gi/solve_watch.glsl.
void addTo(SolveResidual& r, const Watch& w) {
  raise(r.maxDelta, w.delta);
  raise(r.maxH, w.h);
  raise(r.maxGain, w.gain);
  raise(r.maxSource, w.source);
  raise(r.maxRise, w.rise);
  raise(r.maxFall, w.fall);
  raise(r.maxReach, w.reach);
  r.nonFinite += w.nonFinite;
  r.nan += w.nan;
  r.negative += w.negative;
}

}  // namespace

void sweepOnHost(const SolvePush& push, const MatrixArrays& matrix, const FacetArrays& facets, const SolveWork& work,
                 bool tinted) {
  std::vector<Watch> found((matrix.rows + kRowBlock - 1) / kRowBlock, NOTHING);
  parallelFor(found.size(), [&](size_t block) {
    const uint32_t first = kRowBlock * static_cast<uint32_t>(block);
    for (uint32_t row = first; row < std::min(matrix.rows, first + kRowBlock); ++row) {
      const glm::uvec2 info = matrix.rowInfo.at[row];
      const RowSum sum = tinted ? sumOfRow<true>(push, matrix, row, rowEntries(info))
                                : sumOfRow<false>(push, matrix, row, rowEntries(info));
      addWatch(found[block],
               finishRow(push, facets, work, row, sum, std::bit_cast<float>(info.y), push.output_.at[row]));
    }
  });
  if (!watches(work)) return;
  for (const Watch& w : found) addTo(push.residual.at[0], w);
}

}  // namespace irad
