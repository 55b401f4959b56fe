// Which settings are worth their price: the Pareto front of cost and error.
#pragma once

#include <optional>
#include <span>
#include <vector>

namespace irad {

/// What a point costs and how wrong it is: less of either is better.
struct CostAndError {
  double cost = 0, error = 0;
};

/// Of each point: nothing where no other is as good in both and better in one, so that it is on the front; else the
/// front's point that dominates it and has the least error (of equals the cheapest, then the first). Points with a cost
/// or an error that is not finite are dominated by the one with the least error, if there is one, and dominate none.
std::vector<std::optional<size_t>> dominators(std::span<const CostAndError> points);

/// The points on the front, cheapest first.
std::vector<size_t> front(std::span<const CostAndError> points);

}  // namespace irad
