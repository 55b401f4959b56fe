// The relight kernels' records (docs/method.md 6).
#ifndef IRAD_SHARED_SOLVE_H
#define IRAD_SHARED_SOLVE_H
#include "shared/emitters.h"
#include "shared/facets.h"
#include "shared/gi_params.h"
#include "shared/matrix.h"
#include "shared/scene_gpu.h"
#include "shared/surface.h"
#include "shared/trace.h"
IRAD_BEGIN

/// What one sweep reduces. Floats >= 0 as bits, so that the largest is the same whatever the order; counts alike.
struct SolveResidual {
  uint maxDelta;   ///< max |B' - B|, W/m^2
  uint maxH;       ///< W/m^2
  uint maxGain;    ///< largest row gain lambda x max_c rho_c x sum_j F_ij
  uint maxSource;  ///< max |M + W + rho D|, W/m^2
  uint nonFinite;  ///< components of B' that are NaN or infinite
  uint nan;        ///< of those, NaN
  uint negative;   ///< components of M + rho D, H or B', and row sums of F, below zero
  // Of the gains' answer w = 1 + v (docs/method.md 1), v being the fourth component of B: v' = a (F v + F 1).
  uint maxRise;   ///< max v' - v
  uint maxFall;   ///< max v - v'
  uint maxReach;  ///< max v
  uint pad0, pad1;
};
IRAD_CONST uint SOLVE_RESIDUALS = 16u;     ///< sweeps of a submission at most: each reduces into a record of its own
IRAD_CONST float SOLVE_REACH_MAX = 1e20f;  ///< a larger v is given up, and a rise that is no number is this
IRAD_ARRAY(ResidualArray, SolveResidual, 16)

// What a sweep computes.
IRAD_CONST uint SOLVE_SWEEP = 0u;    ///< H = F B, then B'; v stays
IRAD_CONST uint SOLVE_WATCH = 1u;    ///< the same with the reductions of SolveResidual, but for those of v
IRAD_CONST uint SOLVE_PRODUCT = 2u;  ///< output = F input alone
IRAD_CONST uint SOLVE_GAINS = 3u;    ///< SOLVE_WATCH with v', and all of the reductions

struct SolvePush {
  MatrixRecord matrix;
  FacetRecord facets;
  Vec4Array direct;    ///< D
  Vec4Array input_;    ///< B, v (or any vector, SOLVE_PRODUCT)
  Vec4Array output_;   ///< B', v' (or F input)
  Vec4Array indirect;  ///< H
  ResidualArray residual;
  FloatArray rowSum;     ///< sum_j F_ij, written where it is watched
  Vec4Array correction;  ///< F M by samples of the emitters less that by rays
  Vec4Array sky;         ///< irradiance from the sky, where there is one
  Vec4Array reflected;   ///< W, reflections that are written back, where there are any
  float lambda, omega, flush;
  float correctionGain;  ///< the factor on M in B, and so on the correction to F B. 0: there is none
};

// Acceleration (docs/method.md 1): x_0 ... x_n are B, v before and after n sweeps, r_j = x_j+1 - x_j.
IRAD_CONST uint SOLVE_VECTORS = 4u;  ///< n at most
/// gi/solve_sums.comp: what the host adds up after a batch, SOLVE_SUMS arrays with a value per invocation. The first:
/// sum of A H, and of A; the others: of r_a r_b for a < n, b <= a, component by component.
struct SolveSumsPush {
  Vec4Array x0, x1, x2, x3, x4;
  Vec4Array indirect;
  FloatArray area;
  Vec4Array sums;
  uint count, invocations;
};
IRAD_CONST uint SOLVE_SUMS = 11u;         ///< 1 + SOLVE_VECTORS (SOLVE_VECTORS + 1) / 2
IRAD_CONST uint SOLVE_SUMS_FACETS = 32u;  ///< per invocation, as long as there are not more than these:
IRAD_CONST uint SOLVE_SUMS_INVOCATIONS = 4096u;
/// gi/extrapolate.comp: x_0 <- sum_j weight_j x_j+1, and the largest residual of sum_j weight_j x_j.
struct ExtrapolatePush {
  Vec4Array x0, x1, x2, x3, x4;
  ResidualArray residual;                   ///< its maxDelta, roundings included
  vec4 weight0, weight1, weight2, weight3;  ///< by component; each component's sum is 1
  uint count;
  uint pad;
};

/// The first of gi/gather.comp's specialization constants about lights: LIGHT_CONSTANTS of them.
IRAD_CONST uint GATHER_LIGHTS = 1u;

/// gi/gather.comp: D per facet.
struct GatherPush {
  SceneArray scene;
  FacetRecord facets;
  Vec4Array direct;
  vec3 origin;  ///< of the grid, local
  float edge;
  float shadowBias;  ///< texels
  uint pcf;
};

/// gi/gather_surfels.comp.
struct GatherSurfelsPush {
  SceneArray scene;
  FacetArrays facets;  ///< by value
  SurfaceRecord surface;
  ByteArray chebyshev;
  Vec4Array direct;
  vec3 origin;  ///< of the grid, local
  float edge;
  uvec3 dims;
  uint pad;
};

/// gi/outer_light.comp: the radiance of the points outside the grid.
IRAD_CONST uint OUTER_RAYS = 64u;  ///< of a point to the sky and what emits nearby, and as many to emitters far away
struct OuterLightPush {
  SceneArray scene;
  FacetArrays facets;  ///< by value
  SurfaceRecord surface;
  ByteArray chebyshev;
  Vec4Array irradiance, bins;
  vec3 origin;  ///< of the grid, local
  float edge;
  uvec3 dims;
  uint count;
  float emitterPower;  ///< of all tables of gi/outer_emitters.comp; 0: nothing emits
};
/// gi/outer_emitters.comp
struct OuterEmittersPush {
  FacetArrays facets;  ///< by value
  SurfaceRecord surface;
  ByteArray chebyshev;
  EmitterRecord byFacets, byTriangles;  ///< what emits in the grid, where hasFacets; of triangles that reach beyond it
  Vec4Array irradiance;
  uvec3 dims;
  uint count;
  uint hasFacets;
  float power;  ///< of both together
};

/// gi/emission.comp: vec3 exitance -> vec4.
struct EmissionPush {
  FacetRecord facets;
  Vec4Array output_;
};

/// gi/light_squares.comp: B^2, or (B - emissionGain M)^2.
struct LightSquaresPush {
  FacetRecord facets;
  Vec4Array radiosity, output_;
  float emissionGain;
  uint pad;
};
/// gi/row_noise.comp: the standard error of H by a row's rays.
struct RowNoisePush {
  MatrixRecord matrix;
  Vec4Array squares;            ///< F B^2, (W/m^2)^2
  Vec4Array indirect, emitted;  ///< H; F M by samples, where those stand in for rays
  Vec4Array sky;                ///< w: what the sky adds to the squares
  Vec4Array error;              ///< x: W/m^2, over the three channels together; y, z: 0
  float emittedGain;            ///< the factor on M in H; 0: rays bring all of H
  uint pad;
};
/// A row's rays are spread evenly over the hemisphere and over the facet, so that their mean has less variance than the
/// mean of independent rays: this share of it at the most, by measurement (docs/method.md 7).
IRAD_CONST float ROW_NOISE_SHARE = 0.5f;

/// gi/sample_emitters.comp: F M by samples of the emitters.
struct SampleEmittersPush {
  MatrixRecord matrix;
  FacetRecord facets;
  ByteArray chebyshev;
  EmitterRecord emitters;
  Vec4Array emitted;     ///< F M by rays; becomes that by samples, w: their variance were they independent
  Vec4Array correction;  ///< the difference
  Vec4Array byHost;      ///< CONSTANT_BY_HOST: what samples bring, w: the variance
  uvec3 dims;
  float jfaMax;
  uint samples, seed;
  SurfaceRecord surface;  ///< hit rule triangles
};
IRAD_CONST uint EMITTERS_SEED = 0x5A3D9E71u;  ///< with that of the rays: the samples' directions are others
/// Emitters nearer than this, in voxels from centre to centre, are left to the rays: a sample of so near a face would
/// weigh too much.
IRAD_CONST float EMITTERS_NEAR = 4.0f;
IRAD_FN bool areNear(uvec3 a, uvec3 b) {
  vec3 d = vec3(a) - vec3(b);
  return dot(d, d) < EMITTERS_NEAR * EMITTERS_NEAR;
}

/// thesis/scatter_volume.comp (T 5.9): one facet per solid voxel into the sampled volume.
struct ScatterVolumePush {
  FacetRecord facets;
  Vec4Array radiosity;
  Vec4Array direct;  ///< D, read for edge removal
  uvec3 dims;
  float removal;      ///< lambda of T eq. 23 that B was solved with, 0: nothing is subtracted
  UintArray clamped;  ///< counts voxels whose value exceeds what the volume's half floats hold
};
IRAD_CONST float HALF_MAX = 65504.0f;

IRAD_END
#endif
