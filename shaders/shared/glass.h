// Which places of a blended surface are there: a screen, so that whatever meets surfaces as they are (rays, shadow maps)
// passes with 1 - alpha (docs/method.md 4).
#ifndef IRAD_SHARED_GLASS_H
#define IRAD_SHARED_GLASS_H
#include "shared/sampling.h"
IRAD_BEGIN

/// A square of a piece's 8 x 8 is there where alpha is above this, in (0, 1). The squares' thresholds are 64 even steps in
/// the order of a Bayer matrix, shifted by `seed`: of an even alpha 64 alpha of them are there, rounded up or down by
/// chance, none of them more often than another.
IRAD_FN float screenThreshold(uint bit, uint seed) {
  uint x = (bit & 7u) ^ (seed & 7u), y = ((bit >> 3) & 7u) ^ ((seed >> 3) & 7u), d = x ^ y;
  uint rank = ((d & 1u) << 5) | ((y & 1u) << 4) | ((d & 2u) << 2) | ((y & 2u) << 1) | ((d & 4u) >> 1) | ((y & 4u) >> 2);
  return unitFloat((rank << 26) + hashUint(seed));
}

/// The same of a texel of a shadow map: any few neighbours have thresholds that are spread evenly (a Kronecker sequence
/// in two dimensions, by the powers of the root of x^3 = x + 1).
IRAD_FN float texelThreshold(uint x, uint y, uint seed) {
  return unitFloat(x * 3242174889u + y * 2447445414u + hashUint(seed));
}

IRAD_END
#endif
