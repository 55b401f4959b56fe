// How far one picture is from another: the field's metrics, by their exact names (docs/conventions.md, Metrics).
#pragma once

#include <glm/glm.hpp>
#include <limits>
#include <optional>
#include <span>

namespace irad {

/// Added to the squared reference in relMSE, in squared units of the pictures: so that dark pixels do not
/// decide alone. 0.01 as in Rousselle et al. 2011, "Adaptive Sampling and Reconstruction using Greedy Error
/// Minimization", section 4.1.
inline constexpr double kRelMseEpsilon = 0.01;

/// Compares `values` with `reference`, over the first three channels of every element. Elements where either is not
/// finite are left out and counted.
struct Metrics {
  double rmse = 0;          ///< sqrt(mean (v - r)^2), in the pictures' unit
  double relMse = 0;        ///< mean (v - r)^2 / (r^2 + kRelMseEpsilon)
  double scaledRelMse = 0;  ///< mean (v - r)^2 / (r^2 + (0.1 mean r)^2): the same in any unit
  double psnr = 0;          ///< dB: 20 log10(largest r / RMSE); infinite where they are equal
  double meanError = 0;     ///< mean (v - r): signed
  double meanReference = 0;
  double largest = 0;   ///< |v - r|
  size_t elements = 0;  ///< that were compared
  size_t leftOut = 0;
};
Metrics measure(std::span<const glm::vec4> values, std::span<const glm::vec4> reference);

/// Against two references of independent noise, r and s, which then cancels in the mean; m = (r + s) / 2. Elements
/// where one is not finite are left out; NaN where none is left.
struct PairedMetrics {
  double rmse = 0;    ///< sqrt(mean (v - r)(v - s)); 0 where that mean is below 0
  double relMse = 0;  ///< mean (v - r)(v - s) / (m^2 + (0.1 mean m)^2): may be below 0
};
PairedMetrics measurePaired(std::span<const glm::vec4> values, std::span<const glm::vec4> first,
                            std::span<const glm::vec4> second);

/// Of whole pictures. A reference that has noise of its own counts for less by blocks than by pixels, and not at all
/// where there are two of them, with independent noise.
struct PictureMetrics {
  Metrics pixels;
  /// scaledRelMse of the means of blocks of kBlockSide x kBlockSide pixels, the reference's mean over all pixels; what
  /// is left of whole blocks at the right and below is not looked at, nor are blocks that hold a pixel left out. With a
  /// second reference s: mean (v - r)(v - s) / (m^2 + ...), m = (r + s) / 2. NaN without a block.
  double blockRelMse = 0;
  /// Half of a 95 % interval of blockRelMse by the noise of two references alone; NaN where it is not known.
  double blockRelMseHalf = std::numeric_limits<double>::quiet_NaN();
  double flip = 0;  ///< renderer/flip.h, of linear light times `exposure`, clamped to [0, 1]; NaN without one
};
inline constexpr uint32_t kBlockSide = 8;
/// `exposure` none: FLIP, which takes most of the time, is left out. `error`: the standard error of the mean of
/// reference and second, which have as much noise each.
PictureMetrics measurePicture(glm::uvec2 size, std::span<const glm::vec4> values, std::span<const glm::vec4> reference,
                              std::span<const glm::vec4> second = {}, std::optional<double> exposure = 1,
                              std::span<const glm::vec4> error = {});

}  // namespace irad
