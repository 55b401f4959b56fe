// Pictures of several layers against each other, layer by layer: where an error is, by how often light was reflected.
#pragma once

#include <string>
#include <vector>

#include "renderer/base/image_io.h"
#include "renderer/metrics.h"

namespace irad {

struct LayerError {
  std::string name;        ///< "lit", "bounce.2"
  PictureMetrics metrics;  ///< without FLIP: parts of a picture are nothing that one sees
};
/// Of each layer that all of them have but for standard errors. The first goes by what the file says that it shows.
/// With a `second` reference of independent noise the noise of both cancels, and where both have standard errors
/// blockRelMseHalf is known. UsageError where sizes differ or no layer is shared.
std::vector<LayerError> compareLayers(const LayeredPicture& picture, const LayeredPicture& reference,
                                      const LayeredPicture* second = nullptr);

/// In words which bounce has most of the mean error of lit, and how much is of more reflections than there are layers
/// of; empty: the layers do not tell.
std::string bounceFinding(const std::vector<LayerError>& layers);

}  // namespace irad
