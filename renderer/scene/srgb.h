// The sRGB transfer function of 8-bit texels, IEC 61966-2-1, to the last bit: without the processor's own roots and
// powers.
#pragma once

#include <cstdint>

namespace irad {

/// The light that a code stands for, 0..1.
float linearFromSrgb(uint8_t code);
/// The code nearest to a light of 0..1 on sRGB's scale; light outside of it gets the nearest end's code.
uint8_t srgbFromLinear(float light);

}  // namespace irad
