#include "renderer/base/compare_timings.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>
#include <random>

#include "renderer/base/student.h"

namespace irad {
namespace {

constexpr size_t kBlocks = 16;  ///< blocks that a recording is cut into: frames in different ones count as independent
constexpr int kResamples = 200;
constexpr double kErrorRate = 0.05;  ///< for all rows of a table together

/// Standard error of log(median), by a moving-block bootstrap; `values` > 0, in order of time.
double medianError(const std::vector<double>& values, size_t blocks, std::mt19937& random) {
  const size_t n = values.size(), length = (n + blocks - 1) / blocks;
  std::vector<uint32_t> order(n), rank(n), drawn(n);
  std::iota(order.begin(), order.end(), 0u);
  std::sort(order.begin(), order.end(), [&](uint32_t a, uint32_t b) { return values[a] < values[b]; });
  for (uint32_t r = 0; r < n; ++r) rank[order[r]] = r;

  double sum = 0, squares = 0;
  for (int i = 0; i < kResamples; ++i) {
    // Count how often each value is drawn; the median is the lowest with half of the draws at or below it.
    std::fill(drawn.begin(), drawn.end(), 0u);
    for (size_t filled = 0; filled < n;) {
      const size_t first = random() % (n - length + 1), count = std::min(length, n - filled);
      for (size_t j = 0; j < count; ++j) ++drawn[rank[first + j]];
      filled += count;
    }
    size_t below = 0, r = 0;
    while (2 * (below += drawn[r]) < n) ++r;
    const double median = std::log(values[order[r]]);
    sum += median;
    squares += median * median;
  }
  // With so few blocks the resampled variance is too small by 1 / blocks.
  const double mean = sum / kResamples, share = 1 - 1.0 / static_cast<double>(blocks);
  return std::sqrt(std::max(squares / kResamples - mean * mean, 0.0) / share);
}

std::string stagesOf(const FrameSample& frame) {
  std::string names;
  for (const auto& [stage, ms] : frame.stages) names += stage + "\n";
  return names;
}

/// Whole groups of each kind, GPU and CPU. Only those count that ran the commonest set of stages; the others did other
/// work.
std::vector<StageSamples> wholeGroups(const std::deque<FrameSample>& frames) {
  std::vector<StageSamples> out;
  for (size_t k = 0; k < kWorkKinds.size(); ++k) {
    const auto kind = static_cast<WorkKind>(k);
    std::map<std::string, size_t> sets;
    for (const FrameSample& frame : frames)
      if (frame.kind == kind) ++sets[stagesOf(frame)];
    if (sets.empty()) continue;
    const std::string& usual =
        std::max_element(sets.begin(), sets.end(), [](auto& a, auto& b) { return a.second < b.second; })->first;
    StageSamples gpu{kind, kGpuTime, {}}, cpu{kind, kCpuTime, {}};
    for (const FrameSample& frame : frames)
      if (frame.kind == kind && stagesOf(frame) == usual) {
        gpu.ms.push_back(frame.gpuMs());
        cpu.ms.push_back(frame.cpuMs);
      }
    out.push_back(std::move(gpu));
    out.push_back(std::move(cpu));
  }
  return out;
}

std::vector<StageSamples> series(const std::deque<FrameSample>& frames) {
  std::vector<StageSamples> out = stageSamples(frames);
  for (StageSamples& whole : wholeGroups(frames)) out.push_back(std::move(whole));
  std::stable_sort(out.begin(), out.end(), [](const auto& a, const auto& b) { return a.kind < b.kind; });
  return out;
}

}  // namespace

const char* toString(Verdict verdict) {
  constexpr std::array names{"faster", "slower", "within noise", "too few samples"};
  return names.at(static_cast<size_t>(verdict));
}

std::vector<StageChange> compareTimings(const std::deque<FrameSample>& before, const std::deque<FrameSample>& after) {
  const std::vector<StageSamples> first = series(before), second = series(after);
  std::vector<std::pair<const StageSamples*, const StageSamples*>> pairs;
  for (const StageSamples& a : first)
    for (const StageSamples& b : second)
      if (a.kind == b.kind && a.stage == b.stage) pairs.emplace_back(&a, &b);

  std::mt19937 random(1);
  std::vector<StageChange> out;
  for (const auto& [a, b] : pairs) {
    StageChange change{.kind = a->kind, .stage = a->stage};
    change.before = statistics(a->ms).p50;
    change.after = statistics(b->ms).p50;
    change.samples[0] = a->ms.size();
    change.samples[1] = b->ms.size();
    const size_t fewest = std::min(a->ms.size(), b->ms.size());
    const double least =
        std::min(*std::min_element(a->ms.begin(), a->ms.end()), *std::min_element(b->ms.begin(), b->ms.end()));
    if (fewest >= kFewestSamples && least > 0) {
      const size_t blocks = std::min(kBlocks, fewest);
      const double error = std::hypot(medianError(a->ms, blocks, random), medianError(b->ms, blocks, random));
      const double reach =
          error * studentQuantile(kErrorRate / 2 / static_cast<double>(pairs.size()), static_cast<double>(blocks - 1));
      change.ratio = change.after / change.before;
      change.low = change.ratio * std::exp(-reach);
      change.high = change.ratio * std::exp(reach);
      change.verdict = change.low > 1 ? Verdict::Slower : change.high < 1 ? Verdict::Faster : Verdict::WithinNoise;
    }
    out.push_back(std::move(change));
  }
  return out;
}

}  // namespace irad
