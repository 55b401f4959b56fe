// Which places of a blended surface are there: a screen, so that whatever meets surfaces as they are (rays, shadow maps)
// passes with 1 - alpha (docs/method.md 4).
#ifndef IRAD_SHARED_GLASS_H
#define IRAD_SHARED_GLASS_H
#include "shared/sampling.h"
IRAD_BEGIN

/// Alpha of a surface whose texels say `alpha`: with a mask 1 or 0. `cutoff`: GpuMaterial::alphaCutoff of what transmits
/// light.
IRAD_FN float paneAlpha(float alpha, float cutoff) {
  if (cutoff >= 0.0f) return alpha >= cutoff ? 1.0f : 0.0f;
  return min(max(alpha, 0.0f), 1.0f);
}
/// What a pane lets through of each channel, straight on: of what alpha covers the share `transmitted` in its base colour,
/// all of the rest.
IRAD_FN vec3 panePasses(vec3 base, float alpha, float transmitted) {
  return vec3(1.0f - alpha) + base * (alpha * transmitted);
}
/// The same in 30 bits, as a float that no step on the way takes for a denormal or for no number: ten a channel, of the root.
IRAD_FN uint packPasses(vec3 p) {
  return uint(sqrt(p.x) * 1023.0f + 0.5f) | (uint(sqrt(p.y) * 1023.0f + 0.5f) << 10) |
         (uint(sqrt(p.z) * 1023.0f + 0.5f) << 20);
}
IRAD_FN vec3 unpackPasses(uint bits) {
  vec3 root = vec3(float(bits & 1023u), float((bits >> 10) & 1023u), float((bits >> 20) & 1023u)) * (1.0f / 1023.0f);
  return root * root;
}

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
