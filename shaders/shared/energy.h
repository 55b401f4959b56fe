// Where the light of a solve comes from and goes to: the energy balance of the numerical watch (docs/stability.md,
// `energy`).
#ifndef IRAD_SHARED_ENERGY_H
#define IRAD_SHARED_ENERGY_H
#include "shared/facets.h"
#include "shared/types.h"
IRAD_BEGIN

/// Share of the unit square in which p u + q v < t, for p >= q >= 0, p > 0.
IRAD_FN float squareBelow(float p, float q, float t) {
  if (q < 1e-3f * p) return clamp((t - 0.5f * q) / p, 0.0f, 1.0f);
  // The integral over v of clamp((t - q v) / p, 0, 1).
  float x1 = t / p, x0 = (t - q) / p;
  float c1 = clamp(x1, 0.0f, 1.0f), c0 = clamp(x0, 0.0f, 1.0f);
  return p / q * (0.5f * (c1 * c1 - c0 * c0) + max(x1 - 1.0f, 0.0f) - max(x0 - 1.0f, 0.0f));
}

/// Area of a facet's plane inside its voxel, voxels^2. `offset`: facetOffset. A facet's plane counts as inside its
/// voxel. This matters for walls that lie exactly in a voxel's face: the offset's code, or the last bit of the normal,
/// may put them outside.
IRAD_FN float facetArea(vec3 normal, float offset) {
  vec3 a = abs(normal);
  float m = max(a.x, max(a.y, a.z)), q = min(a.x, min(a.y, a.z));
  float p = a.x + a.y + a.z - m - q;
  if (p < q) p = q;  // by rounding
  if (p < 1e-3f) return 1.0f / m;
  // Seen along the normal's largest axis: the part of the unit square over which the plane's height is in the voxel.
  float low = abs(offset) - 0.5f * m + 0.5f * (p + q);
  return (squareBelow(p, q, low + m) - squareBelow(p, q, low)) / m;
}

/// Sums over the facets of an invocation, W/m^2 x voxels^2, by colour channel.
struct EnergySums {
  vec3 entering;  ///< A (M + W + D), and what comes from the sky
  vec3 absorbed;  ///< A (1 - rho) (D + H)
  vec3 escaped;   ///< A B (1 - sum_j F_ij)
};
IRAD_ARRAY(EnergyArray, EnergySums, 4)

/// gi/energy.comp.
struct EnergyPush {
  FacetRecord facets;
  Vec4Array direct, indirect, radiosity;  ///< D, H, B
  FloatArray area, rowSum;
  Vec4Array frames;     ///< w: row sums by brute force, which has no matrix
  Vec4Array sky;        ///< irradiance, where there is one
  Vec4Array reflected;  ///< W, where reflections are written back
  EnergyArray sums;  ///< one per invocation
  uint invocations;
  uint pad;
};
IRAD_CONST uint ENERGY_FACETS = 32u;  ///< per invocation

IRAD_END
#endif
