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

/// Steps of the thresholds from a texel of a shadow map to the next, across and down: Kronecker sequences in two dimensions, in
/// which any few neighbours are spread evenly. The first is by the powers of the root of x^3 = x + 1; the others were
/// sought among random ones, as even under a filter of 4 x 4 texels, and each independent of all before it.
IRAD_FN uvec2 screenSteps(uint k) {
  if (k == 0u) return uvec2(3242174889u, 2447445414u);
  if (k == 1u) return uvec2(1565279396u, 507484357u);
  if (k == 2u) return uvec2(1086790762u, 2510552392u);
  if (k == 3u) return uvec2(2982751720u, 918818908u);
  if (k == 4u) return uvec2(1720594287u, 1086420356u);
  if (k == 5u) return uvec2(572279714u, 1615624954u);
  if (k == 6u) return uvec2(3426901417u, 2805802779u);
  return uvec2(2925646701u, 3250989466u);
}

/// The same of a texel of a shadow map. One sequence, however shifted, says of each texel whether it passes a second pane by
/// whether it has passed the first; so `seed` chooses among 32: the eight, mirrored and with their axes swapped.
IRAD_FN float texelThreshold(uint x, uint y, uint seed) {
  uint hash = hashUint(seed);
  uvec2 steps = screenSteps(hash & 7u);
  uint across = (hash & 8u) != 0u ? ~steps.x + 1u : steps.x;
  bool swapped = (hash & 16u) != 0u;
  return unitFloat((swapped ? y : x) * across + (swapped ? x : y) * steps.y + hash);
}

IRAD_END
#endif
