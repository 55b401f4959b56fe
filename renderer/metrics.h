// How far one picture is from another: the field's metrics, by their exact names.
#pragma once

#include <glm/glm.hpp>
#include <span>

namespace irad {

/// Added to the squared reference in relMSE, in squared units of the pictures: so that dark pixels do not
/// decide alone. 0.01 as in Rousselle et al. 2011, "Adaptive Sampling and Reconstruction using Greedy Error
/// Minimization", section 4.1.
inline constexpr double kRelMseEpsilon = 0.01;

/// Compares `values` with `reference`, over the first three channels of every element. Elements where either is not
/// finite are left out and counted.
struct Metrics {
  double rmse = 0;       ///< sqrt(mean (v - r)^2), in the pictures' unit
  double relMse = 0;     ///< mean (v - r)^2 / (r^2 + kRelMseEpsilon)
  double psnr = 0;       ///< dB: 20 log10(largest r / RMSE); infinite where they are equal
  double meanError = 0;  ///< mean (v - r): signed
  double largest = 0;    ///< |v - r|
  size_t elements = 0;   ///< that were compared
  size_t leftOut = 0;
};
Metrics measure(std::span<const glm::vec4> values, std::span<const glm::vec4> reference);

}  // namespace irad
