// Directions: Hammersley set with +1/2 offset (u is never 0 or 1), toroidal shift per voxel by a hash (Cranley-Patterson),
// cosine-weighted hemisphere (docs/method.md 5). The same functions serve GPU kernels and the oracle.
#ifndef IRAD_SHARED_SAMPLING_H
#define IRAD_SHARED_SAMPLING_H
#include "shared/types.h"
IRAD_BEGIN

/// PCG hash (Jarzynski and Olano 2020, "Hash Functions for GPU Rendering", section 4): a permutation of 32-bit words.
IRAD_FN uint hashUint(uint x) {
  uint state = x * 747796405u + 2891336453u;
  uint word = ((state >> ((state >> 28) + 4u)) ^ state) * 277803737u;
  return (word >> 22) ^ word;
}
/// Uniform in (0, 1): 23 bits, centred; with 24 the half would round up to 1.
IRAD_FN float unitFloat(uint h) { return (float(h >> 9) + 0.5f) * (1.0f / 8388608.0f); }

/// Van der Corput radical inverse in base 2, as a 32-bit fraction.
IRAD_FN uint reverseBits(uint x) {
  x = (x << 16) | (x >> 16);
  x = ((x & 0x00FF00FFu) << 8) | ((x & 0xFF00FF00u) >> 8);
  x = ((x & 0x0F0F0F0Fu) << 4) | ((x & 0xF0F0F0F0u) >> 4);
  x = ((x & 0x33333333u) << 2) | ((x & 0xCCCCCCCCu) >> 2);
  return ((x & 0x55555555u) << 1) | ((x & 0xAAAAAAAAu) >> 1);
}

/// Point k of n of the shifted Hammersley set: shift is a pair of 32-bit fractions. Both coordinates in (0, 1).
IRAD_FN vec2 hammersley(uint k, uint n, uvec2 shift) {
  uint u = uint((float(k) + 0.5f) / float(n) * 16777216.0f) << 8;  // 24-bit fraction
  return vec2(unitFloat(u + shift.x), unitFloat(reverseBits(k) + shift.y));
}

/// Cosine-weighted direction about +Z; T 5.6: theta = acos sqrt(1 - u1), phi = 2 pi u2.
IRAD_FN vec3 cosineDirection(vec2 u) {
  float r = sqrt(u.x);
  float phi = 2.0f * IRAD_PI * u.y;
  return vec3(r * cos(phi), r * sin(phi), sqrt(1.0f - u.x));
}

/// Orthonormal basis with third axis n (Duff et al. 2017, "Building an Orthonormal Basis, Revisited").
IRAD_FN vec3 toWorld(vec3 d, vec3 n) {
  float s = n.z >= 0.0f ? 1.0f : -1.0f;
  float a = -1.0f / (s + n.z);
  float b = n.x * n.y * a;
  vec3 t = vec3(1.0f + s * n.x * n.x * a, s * b, -s * n.x);
  vec3 bt = vec3(b, s + n.y * n.y * a, -n.y);
  return t * d.x + bt * d.y + n * d.z;
}

IRAD_END
#endif
