#include "ui/timing_history.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace irad {
namespace {

constexpr float kNone = std::numeric_limits<float>::quiet_NaN();

}  // namespace

void TimingHistory::update(const Timings& timings) {
  const std::deque<FrameSample>& frames = timings.frames();
  const uint64_t fresh = std::min<uint64_t>(timings.recorded() - seen_, frames.size());
  seen_ = timings.recorded();
  for (size_t i = frames.size() - fresh; i < frames.size(); ++i)
    frames[i].kind == WorkKind::Setup ? appendSetup(frames[i]) : append(frames[i]);
  if (size() <= 2 * kMost) return;
  const auto old = static_cast<ptrdiff_t>(size() - kMost);
  cpuMs_.erase(cpuMs_.begin(), cpuMs_.begin() + old);
  for (Stage& stage : stages_) stage.ms.erase(stage.ms.begin(), stage.ms.begin() + old);
}

void TimingHistory::append(const FrameSample& frame) {
  for (Stage& stage : stages_) stage.ms.push_back(kNone);
  cpuMs_.push_back(static_cast<float>(frame.cpuMs));
  for (const auto& [name, ms] : frame.stages) {
    auto stage = std::find_if(stages_.begin(), stages_.end(), [&, &n = name](const Stage& s) { return s.name == n; });
    if (stage == stages_.end()) stage = stages_.insert(stages_.end(), {name, std::vector<float>(size(), kNone)});
    stage->ms.back() = stage->last = static_cast<float>(ms);
  }
}

void TimingHistory::appendSetup(const FrameSample& setup) {
  for (const auto& [name, ms] : setup.stages) {
    auto row = std::find_if(oneTime_.begin(), oneTime_.end(),
                            [&, &n = name](const OneTime& o) { return o.of == setup.of && o.stage == n; });
    if (row == oneTime_.end()) row = oneTime_.insert(oneTime_.end(), {setup.of, name, {}});
    row->ms.push_back(ms);
  }
  std::stable_partition(oneTime_.begin(), oneTime_.end(), [&](const OneTime& o) { return o.of == setup.of; });
}

float TimingHistory::gpuMs(size_t frame) const {
  float sum = 0;
  for (const Stage& stage : stages_)
    if (!std::isnan(stage.ms.at(frame))) sum += stage.ms[frame];
  return sum;
}

size_t TimingHistory::lastWith(const char* stage, size_t window) const {
  for (const Stage& s : stages_)
    if (s.name == stage)
      for (size_t back = 1; back <= std::min(window, size()); ++back)
        if (!std::isnan(s.ms[size() - back])) return size() - back;
  return size();
}

std::vector<double> TimingHistory::times(const Stage& stage, size_t window) const {
  std::vector<double> out;
  for (size_t i = size() - std::min(window, size()); i < size(); ++i)
    if (!std::isnan(stage.ms[i])) out.push_back(double{stage.ms[i]});
  return out;
}

std::vector<float> TimingHistory::peaks(const std::vector<float>& ms, size_t first, size_t columns) {
  std::vector<float> out(columns, kNone);
  const size_t count = ms.size() - first;
  for (size_t i = 0; i < count; ++i) {
    float& peak = out[i * columns / count];
    if (!std::isnan(ms[first + i]) && !(peak > ms[first + i])) peak = ms[first + i];
  }
  return out;
}

}  // namespace irad
