// Round numbers for axes and legends.
#pragma once

#include <vector>

namespace irad {

/// At most `most` (>= 2) multiples of 1, 2 or 5 times a power of ten within [low, high], ascending; none where low ==
/// high or either is not finite.
std::vector<double> ticks(double low, double high, int most);

}  // namespace irad
