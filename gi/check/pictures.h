// Scenes moved about, and pictures held against each other.
#pragma once

#include "gi/check/path_tracer.h"
#include "gi/check/run.h"

namespace irad {

/// Everything in `scene` that is a length times `s`, so that it looks the same: lights that fall off with distance grow
/// with its square.
Scene scaled(Scene scene, float s);
/// The scene and its cameras under a signed permutation of the axes. Where it mirrors, pictures are flipped left to
/// right.
Scene permuted(Scene scene, const glm::mat3& axes);
CheckPicture flipped(CheckPicture picture);

/// Over all pixels and colour channels.
double meanOf(const CheckPicture& picture);

/// How far a picture is from another, over the other's mean (colour channels).
struct PictureError {
  double mean = 0;        ///< of |difference|
  double largest = 0;     ///< of one channel of one pixel
  double brightness = 0;  ///< of the means
};
/// `picture` / `factor` against `reference`. NaN where either is.
PictureError compare(const CheckPicture& picture, const CheckPicture& reference, double factor = 1);

/// How far a picture is from the path tracer's light (path_tracer.h) of the same size.
struct TruthError {
  double ratio = 0;  ///< of the means, all channels
  /// Means of 4 x 4 pixels, squared error over (truth^2 + eps), eps = (.1 x truth's mean)^2. The halves of truth's
  /// samples stand on either side of the product, so that their noise does not add to it.
  double relMse = 0;
  double uncertainty = 0;  ///< standard error of truth's mean over that mean
};
TruthError compare(const CheckPicture& picture, const TracedLight& truth);

}  // namespace irad
