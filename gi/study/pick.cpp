#include "gi/study/pick.h"

#include <cmath>

namespace irad {

std::optional<size_t> pick(const std::vector<PointSummary>& points, const CostKind& cost, const Budget& budget) {
  std::optional<size_t> best;
  std::pair<double, double> least;
  for (size_t i = 0; i < points.size(); ++i) {
    const PointSummary& p = points[i];
    const double price = cost.of(p), error = p.relMse.mean;
    if (!p.failure.empty() || !std::isfinite(price) || !std::isfinite(error)) continue;
    if (budget.ms && price > *budget.ms) continue;
    if (budget.mib && p.deviceMib > *budget.mib) continue;
    if (budget.error && error > *budget.error) continue;
    const std::pair rank = budget.error ? std::pair(price, error) : std::pair(error, price);
    if (!best || rank < least) best = i, least = rank;
  }
  return best;
}

}  // namespace irad
