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
///
/// Where alpha says how much of a texel is there, colours count by it, so that what a mask cuts off (white around a
/// leaf) does not get into the colour of what it leaves; where nothing is there they count alike. Of a mask every level
/// has as many texels of every alpha as the image itself, the largest where its mean is largest: whatever the
/// cutoff, as much is there from far away as from near. Means alone let leaves vanish that cover less than the cutoff.
std::vector<MipLevel> mipLevels(const SceneImage& image, AlphaMode alpha = AlphaMode::Opaque);
/// What the materials that have an image for their base colour make of its alpha; Opaque where one of them ignores it
/// or there is none, Blend where some blend.
AlphaMode alphaOf(const Scene& scene, size_t image);

}  // namespace irad
