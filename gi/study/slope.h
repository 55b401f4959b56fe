// Where settings stand among the points of a study, and what more time would buy from there.
#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "gi/settings.h"
#include "gi/study/front.h"

namespace irad {

/// Whether a setting has a say in what a point of a study is: not how a picture is shown, nor the seed (studies go
/// through several) or the sweeps between two frames of the window.
bool countsInStudies(const Setting& setting);

struct PlaceInStudy {
  size_t point = 0;
  /// Settings that are otherwise there: "matrix.rays 128 instead of 64", the point's value first. Empty: this is it.
  std::vector<std::string> apart;
};
/// The point, of those that are `usable`, whose settings are nearest: numbers > 0 by the logarithm of their ratio,
/// other numbers by their difference over their range, anything else 1 where it differs; of equals the first. None
/// where no point is usable.
std::optional<PlaceInStudy> placeOf(std::span<const Settings> points, const std::vector<bool>& usable,
                                    const Settings& now);

/// What the front offers from a point on.
struct Slope {
  std::optional<size_t> better;  ///< of a point off the front: the one with the least error for no more cost
  std::optional<size_t> next;    ///< the front's next point with less error, which costs more; none: it ends here
  double exponent = 0;           ///< of that step: error ~ cost^-exponent, between its ends
  /// Error for `more` on top of the cost, along the step, no further than its end.
  double errorFor(const CostAndError& at, double more) const;
};
/// From point `at`, whose cost and error must be finite and > 0. The step begins at `at` itself, on the front or off.
Slope slopeAt(std::span<const CostAndError> points, size_t at);

}  // namespace irad
