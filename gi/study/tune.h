// Which settings to measure next, on the way to the best for a budget.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "gi/study/pick.h"
#include "gi/study/results.h"
#include "gi/study/sweep.h"

namespace irad {

/// The point that a search goes on from: the one that pick() takes; where none is within the budget the one that is
/// nearest to it, by the largest of its quotients; none where none was computed.
std::optional<size_t> nearest(const std::vector<PointSummary>& points, const CostKind& cost, const Budget& budget);

/// Sweeps of the points around one, for SettingGrid::add: each number that is swept at its value, and on either side
/// half-way, by the geometric mean, to the next value in the grid; beyond the last as far as the one before is away,
/// within the setting's range. All combinations, since what one setting costs another may save. Sides closer than
/// kCloseEnough are left out, and what is no number stays as it is; nothing: no side is left.
std::vector<std::string> around(const SettingGrid& grid, size_t point);
inline constexpr double kCloseEnough = 1.1;

/// The rows by which points are chosen: seeds from `firstSeed` up to `seeds` of them, the first `repeats`. What is
/// measured of a chosen point beyond those has no part in the choice, so it says without favour how good it is.
StudyResults chosenBy(StudyResults results, uint32_t firstSeed, uint32_t seeds, uint32_t repeats);
/// The others.
StudyResults unseen(StudyResults results, uint32_t firstSeed, uint32_t seeds, uint32_t repeats);

}  // namespace irad
