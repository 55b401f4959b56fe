// How many sweeps a solve still needs.
#pragma once

#include <cstdint>
#include <optional>
#include <span>

namespace irad {

/// The error bound after so many sweeps.
struct BoundSample {
  uint64_t sweeps;
  double bound;  ///< W/m^2
};

/// Sweeps after the last sample until the bound is `target` (> 0): by the least-squares line through the logarithms of
/// the last 8 samples, for an error that shrinks by the same factor in every sweep. 0: it is there. None: it has not
/// been seen to shrink.
std::optional<double> sweepsLeft(std::span<const BoundSample> samples, double target);

}  // namespace irad
