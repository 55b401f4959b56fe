#include "gi/convergence.h"

#include <algorithm>
#include <cmath>

namespace irad {

std::optional<double> sweepsLeft(std::span<const BoundSample> samples, double target) {
  constexpr size_t kLast = 8;
  samples = samples.last(std::min(samples.size(), kLast));
  if (samples.empty()) return std::nullopt;
  if (samples.back().bound <= target) return 0;

  double n = 0, sumX = 0, sumY = 0, sumXX = 0, sumXY = 0;
  for (const BoundSample& s : samples) {
    const double x = static_cast<double>(s.sweeps), y = std::log(s.bound);
    if (!std::isfinite(y)) continue;
    n += 1;
    sumX += x;
    sumY += y;
    sumXX += x * x;
    sumXY += x * y;
  }
  const double spread = n * sumXX - sumX * sumX;
  if (n < 2 || spread <= 0) return std::nullopt;
  const double slope = (n * sumXY - sumX * sumY) / spread;  // of log bound, per sweep
  if (slope >= 0 || !std::isfinite(samples.back().bound)) return std::nullopt;
  return std::log(target / samples.back().bound) / slope;
}

}  // namespace irad
