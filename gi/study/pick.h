// The settings to take, by what has been measured.
#pragma once

#include <optional>
#include <vector>

#include "gi/study/results.h"

namespace irad {

/// What a point may cost, or how wrong it may be.
struct Budget {
  std::optional<double> ms, mib, error;
};

/// With a budget of ms or mib the point within it that has the least error; with an error the cheapest that has no
/// more, by its mean over the seeds (within the budget, where there is one too). Of equals the cheaper, then the first.
/// None: no point that was computed does.
std::optional<size_t> pick(const std::vector<PointSummary>& points, const CostKind& cost, const Budget& budget);

}  // namespace irad
