// What bumps of a normal map leave of light (docs/method.md 9). With N the vertices' unit normal and n the map's, on
// the side that is seen: L = rho / pi x integral of L_i max(0, n.w) G dw. Light that grazes the surface comes to what
// leans towards it past other bumps; by its cosine alone a bump would give back more than falls on the surface.
#ifndef IRAD_SHARED_NORMAL_MAPS_H
#define IRAD_SHARED_NORMAL_MAPS_H
#include "shared/types.h"
IRAD_BEGIN

/// G of a direction w: min(1, g + g^2 - g^3), g = N.w / (N.n n.w), 0 where g < 0 (Chiang, Li and Burley 2019).
IRAD_FN float pastBumps(float smoothMapped, float smoothLight, float mappedLight) {
  float flat_ = smoothMapped * mappedLight;  // N.w where g is 1
  if (flat_ < 0.0f) {
    flat_ = -flat_;
    smoothLight = -smoothLight;
  }
  if (smoothLight >= flat_) return 1.0f;
  if (!(smoothLight > 0.0f)) return 0.0f;
  float g = smoothLight / flat_;
  return g * (1.0f + g * (1.0f - g));
}

/// The share of an even sky that is left: 1/pi x integral of max(0, n.w) G over the hemisphere in front of N, by the
/// cosine c = N.n.
///
/// In the plane of N and n let u be the angle from n to w, away from N, and t = tan(N, n). g = 1 - t tan u depends on
/// it alone, and G = 1 - 2 (t tan u)^2 + (t tan u)^3 for u > 0. Across that plane the integral is pi / 2, and
///   k = 1/2 (1 + integral from 0 to pi/2 - (N, n) of G cos u du)
///     = 1/2 (1 + c + s^2 (c / (1 + s)^2 - 2 (atanh c - c) / c^2)),    s = sin(N, n).
/// So written it is within 3e-6 of the integral in single precision; below c = 1/4 a series takes the place of the
/// logarithm, of which the difference would leave few digits.
IRAD_FN float keptOfEvenSky(float c) {
  if (!(c > 0.0f)) return 0.0f;
  if (c >= 1.0f) return 1.0f;
  float c2 = c * c;
  float s2 = 1.0f - c2;
  float s = sqrt(s2);
  float grazing = c * (1.0f / 3.0f + c2 * (1.0f / 5.0f + c2 * (1.0f / 7.0f + c2 * (1.0f / 9.0f))));
  if (c >= 0.25f) grazing = (log((1.0f + c) / s) - c) / c2;
  return 0.5f * (1.0f + c + s2 * (c / ((1.0f + s) * (1.0f + s)) - 2.0f * grazing));
}

/// N.n of a texel: tangent frames are orthonormal, so that the angle is the same in every one.
IRAD_FN float tangentCosine(vec3 texel, float normalScale) {
  vec3 s = texel * 2.0f - vec3(1.0f);
  s.x *= normalScale;
  s.y *= normalScale;
  float square = s.x * s.x + s.y * s.y + s.z * s.z;
  return square > 0.0f ? s.z / sqrt(square) : 1.0f;
}

IRAD_END
#endif
