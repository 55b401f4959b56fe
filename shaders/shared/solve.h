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
  uint maxSource;  ///< max |M + rho D|, W/m^2
  uint nonFinite;  ///< components of B' that are NaN or infinite
  uint nan;        ///< of those, NaN
  uint negative;   ///< components of M + rho D, H or B', and row sums of F, below zero
  uint pad;
};
IRAD_ARRAY(ResidualArray, SolveResidual, 16)

// Specialization constant 1 of gi/solve_*.comp (0: the matrix's format): what is computed.
IRAD_CONST uint SOLVE_SWEEP = 0u;    ///< H = F B, then B'
IRAD_CONST uint SOLVE_WATCH = 1u;    ///< the same with the reductions of SolveResidual
IRAD_CONST uint SOLVE_PRODUCT = 2u;  ///< output = F input alone

struct SolvePush {
  MatrixRecord matrix;
  FacetRecord facets;
  Vec4Array direct;    ///< D
  Vec4Array input_;    ///< B (or any vector, SOLVE_PRODUCT)
  Vec4Array output_;   ///< B' (or F input)
  Vec4Array indirect;  ///< H
  ResidualArray residual;
  FloatArray rowSum;     ///< sum_j F_ij, written with SOLVE_WATCH
  Vec4Array correction;  ///< F M by samples of the emitters less that by rays
  float lambda, omega, flush;
  float correctionGain;  ///< the factor on M in B, and so on the correction to F B. 0: there is none
};

/// gi/solve_image.comp: a vector of facets as an image, row by row.
struct SolveImagePush {
  Vec4Array vector;
  uint count;
  uint pad;
};
IRAD_CONST uint SOLVE_IMAGE_WIDTH = 1024u;
IRAD_FN ivec2 solveTexel(uint i) {
  return ivec2(int(i % SOLVE_IMAGE_WIDTH), int(i / SOLVE_IMAGE_WIDTH));
}

/// The first of gi/gather.comp's specialization constants about lights: LIGHT_CONSTANTS of them.
IRAD_CONST uint GATHER_LIGHTS = 1u;

/// gi/gather.comp: D per facet.
struct GatherPush {
  SceneArray scene;
  FacetRecord facets;
  Vec4Array direct;
  vec3 origin;  ///< of the grid, local
  float edge;
  uint samples;
  float shadowBias;  ///< texels
  uint pcf;
  uint pad;
  SurfaceRecord surface;  ///< 0: facets are planes
};

/// gi/emission.comp: vec3 exitance -> vec4.
struct EmissionPush {
  FacetRecord facets;
  Vec4Array output_;
};

/// gi/sample_emitters.comp: F M by samples of the emitters.
struct SampleEmittersPush {
  MatrixRecord matrix;
  FacetRecord facets;
  ByteArray chebyshev;
  EmitterRecord emitters;
  Vec4Array emitted;     ///< F M by rays; becomes that by samples
  Vec4Array correction;  ///< the difference
  uvec3 dims;
  float jfaMax;
  uint samples, seed;
  SurfaceRecord surface;  ///< hit rule triangles
};
/// Emitters nearer than this, in voxels from centre to centre, are left to the rays: a sample of so near a face would
/// weigh too much.
IRAD_CONST float EMITTERS_NEAR = 4.0f;

/// gi/scatter_facets.comp: H (and F M) blurred, as shading samples them.
struct ScatterFacetsPush {
  FacetRecord facets;
  Vec4Array indirect, emitted;
  Vec4Array blurred, blurredEmitted;
  UintArray change;  ///< [0]: float bits of the largest |blurred - H|, W/m^2
  uvec3 dims;
  uint pad;
};

/// thesis/scatter_volume.comp (T 5.9): one facet per solid voxel into the sampled volume.
struct ScatterVolumePush {
  FacetRecord facets;
  Vec4Array value;   ///< H or B
  Vec4Array direct;  ///< D, read for edge removal
  uvec3 dims;
  float removal;      ///< lambda of T eq. 23 that B was solved with, 0: nothing is subtracted
  UintArray clamped;  ///< counts voxels whose value exceeds what the volume's half floats hold
};
IRAD_CONST float HALF_MAX = 65504.0f;

IRAD_END
#endif
