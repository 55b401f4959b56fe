// Means of few samples, and how far they may be off.
#pragma once

#include <span>

namespace irad {

/// t with P(T > t) = `upper` (0 < upper < 0.5) for Student's distribution of so many degrees of freedom.
double studentQuantile(double upper, double freedom);

/// Mean of samples of a normal distribution, and the half width of its 95 % interval by Student's t; infinite for fewer
/// than two samples.
struct MeanInterval {
  double mean = 0, half = 0;
};
MeanInterval meanInterval(std::span<const double> samples);

}  // namespace irad
