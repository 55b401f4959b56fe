#include "gi/study/front.h"

#include <algorithm>
#include <cmath>

namespace irad {
namespace {

bool isFinite(const CostAndError& p) {
  return std::isfinite(p.cost) && std::isfinite(p.error);
}

/// Finite points by cost, then error, then number.
std::vector<size_t> byCost(std::span<const CostAndError> points) {
  std::vector<size_t> order;
  for (size_t i = 0; i < points.size(); ++i)
    if (isFinite(points[i])) order.push_back(i);
  std::stable_sort(order.begin(), order.end(), [&](size_t a, size_t b) {
    return points[a].cost != points[b].cost ? points[a].cost < points[b].cost : points[a].error < points[b].error;
  });
  return order;
}

}  // namespace

std::vector<std::optional<size_t>> dominators(std::span<const CostAndError> points) {
  std::vector<std::optional<size_t>> out(points.size());
  std::optional<size_t> best;  // the last of the front so far: of all that cost no more it has the least error
  for (const size_t i : byCost(points)) {
    const bool same = best && points[i].cost == points[*best].cost && points[i].error == points[*best].error;
    if (!best || points[i].error < points[*best].error)
      best = i;
    else if (!same)
      out[i] = best;
  }
  for (size_t i = 0; i < points.size(); ++i)
    if (!isFinite(points[i])) out[i] = best;
  return out;
}

std::vector<size_t> front(std::span<const CostAndError> points) {
  const std::vector<std::optional<size_t>> by = dominators(points);
  std::vector<size_t> out = byCost(points);
  std::erase_if(out, [&](size_t i) { return by[i].has_value(); });
  return out;
}

}  // namespace irad
