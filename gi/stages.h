// The stages of the method: each a function that takes handles and returns handles, one file per stage, called in order
// by pipeline.cpp. Stage names and equations: METHOD.md.
#pragma once

#include <functional>
#include <vector>

#include "gi/settings.h"
#include "renderer/frame.h"
#include "renderer/gpu_scene.h"
#include "renderer/shadow.h"
#include "shaders/shared/emitters.h"
#include "shaders/shared/facets.h"
#include "shaders/shared/grid.h"
#include "shaders/shared/matrix.h"

namespace irad {

// ---- 2. Grid (T 5.1.1) ----------------------------------------------------------------------------------------------
/// Bounds are local fp32; the arithmetic is double. Throws UsageError when an axis would exceed 1022 + 2 voxels.
Grid makeGrid(glm::vec3 boundsMin, glm::vec3 boundsMax, uint32_t resolution);
/// T eq. 4-7 to the letter (thesis.literal): no padding, floored dimensions, p == max outside.
Grid makeLiteralGrid(glm::vec3 boundsMin, glm::vec3 boundsMax, uint32_t resolution);

// ---- Prefix sum -----------------------------------------------------------------------------------------------------
/// Exclusive scan of `count` uints in place; the total is written to `total` (one uint at element 0). Deterministic.
void exclusiveScan(Frame& frame, const char* stage, const Buffer& values, uint32_t count, const Buffer& total);

// ---- 2. Voxelization ------------------------------------------------------------------------------------------------
/// Per voxel and facet slot: which triangle won (ordered atomic key), and its attributes.
struct Voxels {
  Grid grid;
  Buffer gridRecord;                     ///< one Grid
  uint32_t slots = 1;                    ///< voxel.facets
  Buffer keys;                           ///< slots x voxels uints, voxelKey of shared/voxelize.h; 0 = empty
  const SceneOnDevice* scene = nullptr;  ///< of which compactFacets reads the winners' attributes
};
Voxels voxelize(Context& context, const SceneOnDevice& scene, const Settings& settings);

// ---- 4. Facet list (T 5.3) ------------------------------------------------------------------------------------------
struct FacetList {
  Grid grid;
  uint32_t count = 0;  ///< facets
  uint32_t solidVoxels = 0;
  uint32_t clampedAlbedo = 0;  ///< facets whose albedo was outside [0, .98] or not a number
  Buffer voxel, shape, albedo, emission, reverse, around;
  Buffer record;  ///< one FacetArrays
  bool hasEmission = false;
  NormalEncoding encoding = NormalEncoding::oct16;
  FacetArrays addresses() const;
};
/// Morton-ordered compaction by prefix sum, then the attributes of every facet. Frees the keys of `voxels`.
FacetList compactFacets(Context& context, Voxels& voxels, const Settings& settings);
/// Sets FACET_CORNER, the clear distance and the joints in the list's shape words, and fills `around`; the last step of
/// the two functions that make lists.
void markCorners(Context& context, FacetList& list);
/// For tests and check scenes: the list from host arrays (already in Morton order), reverse map included.
FacetList uploadFacets(Context& context, const Grid& grid, const std::vector<uint32_t>& voxel,
                       const std::vector<uint32_t>& shape, const std::vector<glm::uvec2>& albedo,
                       const std::vector<glm::vec3>& emission, NormalEncoding encoding);

// ---- 3. Distance fields (T 5.2) -------------------------------------------------------------------------------------
struct Field {
  FieldMethod method = FieldMethod::chebyshev;
  Buffer
      chebyshev;  ///< one byte per voxel, 4 per uint, x fastest: exact Chebyshev distance to the nearest solid, 0..255
  Image jfaDistance;             ///< R8_UNORM volume: Euclidean distance / maxDistance
  float jfaMax = 0;              ///< voxels that 1.0 stands for
  Image jfaSeeds;                ///< R32_UINT packVoxel of the nearest seed, the last pass
  std::vector<Image> jfaPasses;  ///< every pass, on request (field.keep_passes)
};
/// Builds what `settings` and the solid set (facets.reverse) call for.
Field buildField(Context& context, const FacetList& facets, const Settings& settings);

// ---- 5. Form-factor matrix ------------------------------------------------------------------------------------------
struct MatrixStats {
  uint64_t rays = 0, hits = 0, entries = 0, escaped = 0, invalid = 0;
  uint64_t bytesUsed = 0, bytesAllocated = 0;  ///< used: of filled entries (padded: 8 B per hit)
  uint32_t largestRow = 0;
};
struct FormFactors {
  MatrixFormat format = MatrixFormat::csr;
  uint32_t rows = 0, rays = 0;
  std::vector<Buffer> segments;  ///< entries of rowsPerSegment rows each (csr), or of fixed stride (padded)
  Buffer rowStart;               ///< rows: first entry within its segment
  Buffer rowInfo;                ///< rows: entries | ... see shared/matrix.h
  Buffer record;                 ///< one MatrixArrays
  MatrixStats stats;
};
/// `progress` (0..1) may be empty; it returns false to cancel, upon which a WorkError "cancelled" is thrown.
FormFactors buildMatrix(Context& context, const FacetList& facets, const Field& field, const Settings& settings,
                        const std::function<bool(float)>& progress = {});

/// The facets that emit, to be drawn in proportion to their power. count 0: none, and no buffers.
struct Emitters {
  uint32_t count = 0;
  float brightest = 0;  ///< largest luminance(M), W/m^2
  Buffer entries, record;  ///< Emitter per facet, one EmitterTable
};
Emitters listEmitters(Context& context, const FacetList& facets);
/// Vose's alias table of facets[i] with probability powers[i] / sum; powers > 0.
std::vector<Emitter> makeAliasTable(const std::vector<uint32_t>& facets, const std::vector<double>& powers);

// ---- 6. Relight (T 5.7-5.9) -----------------------------------------------------------------------------------------
struct SolveReport {
  uint32_t sweeps = 0;
  float residual = 0;  ///< max |dB| of the last sweep, W/m^2
  float bound = 0;     ///< rho/(1-rho) max|dB|: error bound on B, W/m^2
  float largestH = 0;
  float largestGain = 0;  ///< rho-bar: largest row gain
  uint32_t nonFinite = 0, negative = 0;
  bool converged = false;
  bool diverging = false;  ///< gain >= 1 and growing (solver.lambda too large): stopped early
};
/// Per-facet light, fp32 vec4 (xyz, w unused): W/m^2.
struct Lighting {
  Buffer direct;    ///< D
  Buffer emitted;   ///< F M: first gather from emissive facets alone (the part of H that is direct light of emitters)
  Buffer correction;  ///< what samples of the emitters add to F M by rays; none where they are not sampled
  /// Sum of F M by samples over that by rays; 0: not sampled. Far from 1 the samples are not used (solve.cpp).
  float sampledShare = 0;
  Buffer indirect;    ///< H
  Buffer radiosity, radiosityNext;  ///< B, double buffer
  Buffer shaded;         ///< H as shading samples it (blurred over neighbours that face the same way, or edge-removed)
  Buffer shadedEmitted;  ///< `emitted` likewise
  Image volume;          ///< RGBA16F: the thesis's RadianceTexture (only for ungated sampling, views and exports)
  Buffer residual;       ///< solver's reductions, see shared/solve.h
  SolveReport report;
  /// solve() computes `emitted` when this is not set, and sets it; clear it when the matrix or the emission changes.
  bool emittedCurrent = false;
  float litH = 0;  ///< largest H since a source last shone: with all sources dark, light below 1e-6 of it is put out
};
/// All zero. The volume exists when sampling is ungated; addVolume makes it otherwise (views, exports).
Lighting makeLighting(Context& context, const FacetList& facets, const Settings& settings);
void addVolume(Context& context, const FacetList& facets, Lighting& light);
void gather(Frame& frame, const SceneOnDevice& scene, const ShadowMaps& shadows, const FacetList& facets,
            Lighting& light, const Settings& settings);
/// F M by samples of the emitters in place of rays; empty: by rays.
struct EmitterSource {
  const Emitters* emitters = nullptr;
  const Field* field = nullptr;
};
/// Runs sweeps until the bound is met, `maxSweeps` at most; warm start from light.radiosity. Blocking.
SolveReport solve(Context& context, const FacetList& facets, const FormFactors& matrix, Lighting& light,
                  const Settings& settings, uint32_t maxSweeps, const EmitterSource& source = {});
/// `shaded` and `shadedEmitted`; and the volume where it exists: H, or B with ungated sampling (T 5.9), or B - lambda
/// (M + rho D) with edge removal (T eq. 23), W/m^2 in all cases, the first facet of a voxel, alpha 1.
void scatter(Frame& frame, const FacetList& facets, Lighting& light, const Settings& settings);

}  // namespace irad
