// Mip levels of an image.
#pragma once

#include <vector>

#include "renderer/scene/scene.h"

namespace irad {

/// How many levels there are from width x height texels down to 1 x 1.
uint32_t mipCount(uint32_t width, uint32_t height);

struct MipLevel {
  uint32_t width, height;     ///< half the level above's, rounded down, 1 at least
  std::vector<uint8_t> rgba;  ///< as SceneImage's
};

/// The levels from 1 on, down to 1 x 1: every texel is the mean, in linear light, of those of the level above that it
/// covers, a partly covered one (of an odd number) by its part; rounded once, for the level itself. The same bytes
/// everywhere, where a device's blits round at every level and approximate sRGB each in its own way: Mesa's CPU
/// driver's were 1.4 % too dark after a few levels, and another machine's others.
std::vector<MipLevel> mipLevels(const SceneImage& image);

}  // namespace irad
