// Two recordings compared stage by stage, so that noise is not read as a change.
#pragma once

#include <string>
#include <vector>

#include "renderer/base/timings.h"

namespace irad {

enum class Verdict { Faster, Slower, WithinNoise, TooFew };
const char* toString(Verdict verdict);  ///< "within noise"

/// How long a stage takes in `after`, as a multiple of what it takes in `before`.
struct StageChange {
  WorkKind kind;
  std::string stage;                    ///< or kCpuTime and kGpuTime, of whole groups
  double before = 0, after = 0;         ///< medians, ms
  size_t samples[2] = {0, 0};           ///< of either
  double ratio = 0, low = 0, high = 0;  ///< of the medians, and its interval
  Verdict verdict = Verdict::TooFew;
};
inline constexpr const char *kGpuTime = "all GPU", *kCpuTime = "all CPU";

/// Stages that both have, kind by kind. The interval is that of log(ratio) +- t se: se by a moving-block bootstrap of
/// either median (Kuensch 1989, Ann. Statist. 17; successive frames resemble each other, so blocks of them are drawn),
/// t Student's quantile for as many degrees of freedom as there are blocks, at 5 % for all rows of the table together
/// (Bonferroni). An interval that holds 1 is within noise. TooFew: under kFewestSamples of either, or medians of 0.
/// Between recordings of the same thing (300 frames, noise of 5 %) a row is called changed in 2 % of the cases, in 3 %
/// where 80 % of a frame's noise carries over to the next; with 60 such frames in 10 %. A drift slower than a recording
/// lasts cannot be seen in it: record long, and in turn.
std::vector<StageChange> compareTimings(const std::deque<FrameSample>& before, const std::deque<FrameSample>& after);
inline constexpr size_t kFewestSamples = 10;

}  // namespace irad
