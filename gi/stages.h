// The stages of the method: each a function that takes handles and returns handles, one file per stage, called in order
// by pipeline.cpp. Stage names and equations: METHOD.md.
#pragma once

#include <functional>
#include <limits>
#include <optional>
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

// ---- Rasterization --------------------------------------------------------------------------------------------------
/// Who rasterizes (renderer/raster.h). UsageError where kernels are asked for that the device cannot run.
bool rasterizesByKernels(const Device& device, const Settings& settings);

// ---- 2. Voxelization ------------------------------------------------------------------------------------------------
/// Per voxel and facet slot: which triangle won (ordered atomic key), and its attributes.
struct Voxels {
  Grid grid;
  Buffer gridRecord;                     ///< one Grid
  uint32_t slots = 1;                    ///< facets of a voxel that were looked for
  Buffer keys;                           ///< slots x voxels uints, voxelKey of shared/voxelize.h; 0 = empty
  const SceneOnDevice* scene = nullptr;  ///< of which compactFacets reads the winners' attributes
};
Voxels voxelize(Context& context, const SceneOnDevice& scene, const Settings& settings);

// ---- 4. Facet list (T 5.3) ------------------------------------------------------------------------------------------
struct FacetList {
  Grid grid;
  uint32_t count = 0;  ///< facets
  uint32_t solidVoxels = 0;
  uint32_t slots = MAX_VOXEL_FACETS;  ///< facets of a voxel at most
  uint32_t clampedAlbedo = 0;  ///< facets whose albedo was outside [0, .98] or not a number
  Buffer voxel, shape, albedo, emission, reverse, around;
  Buffer triangle;  ///< which triangle won, | BACK_SIDE where its back did, for the inspector; none of uploaded lists
  Buffer record;    ///< one FacetArrays
  bool hasEmission = false;
  NormalEncoding encoding = NormalEncoding::oct16;
  FacetArrays addresses() const;
};
/// Morton-ordered compaction by prefix sum, then the attributes of every facet. Frees the keys of `voxels`.
FacetList compactFacets(Context& context, Voxels& voxels, const Settings& settings);
/// Sets FACET_CORNER, the clear distance and the joints in the list's shape words, and fills `around`; the last step of
/// the two functions that make lists. `slots`: facets of a voxel that were looked for.
void markCorners(Context& context, FacetList& list, uint32_t slots);
/// For tests and check scenes: the list from host arrays (already in Morton order), reverse map included.
FacetList uploadFacets(Context& context, const Grid& grid, const std::vector<uint32_t>& voxel,
                       const std::vector<uint32_t>& shape, const std::vector<glm::uvec2>& albedo,
                       const std::vector<glm::vec3>& emission, NormalEncoding encoding);

// ---- 3. Distance fields (T 5.2) -------------------------------------------------------------------------------------
struct Field {
  FieldMethod method = FieldMethod::chebyshev;
  Buffer
      chebyshev;  ///< one byte per voxel, 4 per uint, x fastest: exact Chebyshev distance to the nearest solid, 0..255
  Image jfaDistance;  ///< R8_UNORM volume: Euclidean distance / maxDistance
  float jfaMax = 0;   ///< voxels that 1.0 stands for
  Image jfaSeeds;     ///< R32_UINT packVoxel of the nearest seed, the last pass
  /// False: no field was made.
  explicit operator bool() const { return chebyshev || jfaDistance; }
};
/// Builds what `settings` and the solid set (facets.reverse) call for.
Field buildField(Context& context, const FacetList& facets, const Settings& settings);
/// The same recorded into a frame, of one method; `grid` holds the list's one Grid.
Field recordField(Frame& frame, const char* stage, const FacetList& facets, const Buffer& grid, FieldMethod method);
/// Passes of jump flooding: floor(log2(largest dimension)) + 1.
uint32_t jumpFloodPasses(const Grid& grid);
/// The nearest seed that each voxel knows after the first `passes` of them, packVoxel or NO_SEED; 0: solid voxels know
/// themselves.
Buffer recordJumpFlood(Frame& frame, const char* stage, const FacetList& facets, const Buffer& grid, uint32_t passes);

// ---- 5. Form-factor matrix ------------------------------------------------------------------------------------------
struct MatrixStats {
  uint64_t rays = 0, hits = 0, entries = 0, escaped = 0, invalid = 0;
  uint64_t bytesUsed = 0, bytesAllocated = 0;  ///< used: of filled entries (padded: 8 B per hit)
  uint32_t largestRow = 0;
};
/// Where none was built there are no rows, and no buffers.
struct FormFactors {
  MatrixFormat format = MatrixFormat::csr;
  uint32_t rows = 0, rays = 0;
  std::vector<Buffer> segments;  ///< entries of rowsPerSegment rows each (csr), or of fixed stride (padded)
  Buffer rowStart;               ///< rows: first entry within its segment
  Buffer rowInfo;                ///< rows: entries | ... see shared/matrix.h
  Buffer record;                 ///< one MatrixArrays; from kSegmentTable on, the segments' addresses
  static constexpr uint64_t kSegmentTable = 64;
  MatrixStats stats;
  explicit operator bool() const { return static_cast<bool>(record); }
};
/// `progress` (0..1) may be empty; it returns false to cancel, upon which a WorkError "cancelled" is thrown.
FormFactors buildMatrix(Context& context, const FacetList& facets, const Field& field, const Settings& settings,
                        const std::function<bool(float)>& progress = {});

/// The facets that emit, to be drawn in proportion to their power. count 0: none, and no buffers.
struct Emitters {
  uint32_t count = 0;
  float brightest = 0;     ///< largest luminance(M), W/m^2
  Buffer entries, record;  ///< Emitter per facet, one EmitterTable
};
Emitters listEmitters(Context& context, const FacetList& facets);
/// The triangles of emissive materials, in voxel units, for pixels that look for emitters themselves
/// (shaders/shared/pixel_emitters.h). None where nothing emits, or more triangles than that takes.
struct EmissiveTriangles {
  uint32_t count = 0;
  Buffer triangles;  ///< an EmissiveTriangle each
};
struct MaterialTraits;
EmissiveTriangles listEmissiveTriangles(Context& context, const SceneOnDevice& scene,
                                        std::span<const MaterialTraits> materials, const FacetList& facets,
                                        const Buffer& grid);
/// Vose's alias table of facets[i] with probability powers[i] / sum; powers > 0.
std::vector<Emitter> makeAliasTable(const std::vector<uint32_t>& facets, const std::vector<double>& powers);

// ---- 6. Relight (T 5.7-5.9) -----------------------------------------------------------------------------------------
/// The first wrong number: of the earliest stage whose product holds one, the facet of the lowest index.
struct Defect {
  const char* stage;     ///< METHOD section 11: "GI Gather"
  const char* quantity;  ///< "direct irradiance"
  const char* value;     ///< "NaN", "infinite" or "negative"
  uint32_t facet;
  glm::uvec3 voxel;
};
/// Where the light of a converged solve comes from and goes to, W/m^2 x voxels^2, by colour channel. By reciprocity
/// what enters is what is absorbed and what escapes; the rest is how far F departs from A_i F_ij = A_j F_ji.
struct EnergyBalance {
  glm::dvec3 entering{0};  ///< sum of A (M + D)
  glm::dvec3 absorbed{0};  ///< sum of A (1 - rho) (D + H)
  glm::dvec3 escaped{0};   ///< sum of A B (1 - sum_j F_ij)
  /// (absorbed + escaped - entering) / entering of the channel where it is largest; 0 in the dark.
  double imbalance() const;
};
struct SolveReport {
  uint32_t sweeps = 0;
  float residual = 0;  ///< max |dB| of the last sweep, W/m^2
  float bound = 0;     ///< rho/(1-rho) max|dB|: error bound on B, W/m^2
  float allowed = 0;   ///< bound at which the solver sleeps, W/m^2
  float largestH = 0;
  float largestGain = 0;            ///< rho-bar: largest row gain
  uint32_t nonFinite = 0, nan = 0;  ///< components of B that are NaN or infinite; of those, NaN
  uint32_t negative = 0;            ///< components of M + rho D, H or B, and row sums, below zero
  bool converged = false;
  bool diverging =
      false;            ///< growing under any relaxation (solver.lambda too large): stopped, the light before is back
  bool damped = false;  ///< the guard took omega below solver.omega
  float omega = 1;      ///< relaxation of the last sweep
  float growth = 0;     ///< of the residual in the last sweep, as a factor, where it may grow (largestGain >= 1)
  std::optional<Defect> defect;         ///< with nonFinite or negative
  std::optional<EnergyBalance> energy;  ///< of a converged solve with solver.lambda 1
  std::optional<float> blurChange;  ///< by scatter(), where it watches the blur: the most that it changes H by, W/m^2
  uint32_t clampedVoxels = 0;       ///< by scatter(): whose light exceeds the 65504 W/m^2 that the volume holds
  /// No sweep more would change anything for the better.
  bool settled() const { return converged || diverging || nonFinite > 0; }
};
/// Steps in where the residual grows. What a sweep multiplies B by, A = lambda rho F, has no negative entry: its
/// spectral radius r is an eigenvalue (Perron), which a damped sweep turns into 1 - omega + omega r, below 1 only where
/// r is. Damping therefore mends no true divergence; but where a row gain exceeds 1 and r does not, the residual may
/// grow for a while, and damping tells the two apart before B has grown far.
struct DivergenceGuard {
  static constexpr uint32_t kPatience = 5;  ///< growing sweeps in a row before it halves omega; again, and it gives up
  float lambda = 0, asked = 0;              ///< the settings that it was begun with
  float omega = 1;                          ///< in use
  float step = std::numeric_limits<float>::infinity();  ///< max |dB| / omega: what the last sweep would change undamped
  float growth = 0;                                     ///< of `step`, as a factor
  uint32_t growing = 0;
  bool damped = false, gaveUp = false;
  Buffer radiosity, indirect;  ///< B and H from before, where lambda lets them diverge
  /// After a sweep: its largest row gain and residual.
  void judge(float gain, float residual);
};
/// Per-facet light, fp32 vec4 (xyz, w unused): W/m^2.
struct Lighting {
  Buffer direct;  ///< D
  /// F M: first gather from emissive facets alone (the part of H that is direct light of emitters). None where nothing
  /// emits.
  Buffer emitted;
  Buffer correction;  ///< what samples of the emitters add to F M by rays; none where they are not sampled
  /// Sum of F M by samples over that by rays; 0: not sampled. Far from 1 the samples are not used (solve.cpp).
  float sampledShare = 0;
  Buffer indirect;                  ///< H
  Buffer radiosity, radiosityNext;  ///< B, double buffer
  Buffer blurred;         ///< H averaged over neighbours that face the same way; none where shading samples H itself
  Buffer blurredEmitted;  ///< `emitted` likewise
  Buffer blurChange;      ///< largest |blurred - H|, float bits; where scatter() watches it
  Image volume;           ///< RGBA16F: the thesis's RadianceTexture (only for ungated sampling, views and exports)
  Buffer residual;        ///< solver's reductions, see shared/solve.h
  Buffer rowSum;          ///< sum_j F_ij, one float each
  Buffer clamped;         ///< counter of the volume's clamped voxels; with the volume
  SolveReport report;
  DivergenceGuard guard;
  /// solve() computes `emitted` when this is not set, and sets it; clear it when the matrix or the emission changes.
  bool emittedCurrent = false;
  /// What shading samples, H and F M, blurred or not.
  const Buffer& shaded() const { return blurred ? blurred : indirect; }
  const Buffer& shadedEmitted() const { return blurred ? blurredEmitted : emitted; }
  /// False: there is no light and nothing is stored of it; every value is 0.
  explicit operator bool() const { return static_cast<bool>(radiosity); }
  /// Largest H while sources last shone, W/m^2: in the dark, light below 1e-6 of it is put out; reflections of less
  /// than specular.threshold of it are not traced.
  float litH = 0;
};
/// All zero. The volume exists when sampling is ungated; addVolume makes it otherwise (views, exports). Blurred copies
/// exist where scatter() blurs, which makes and frees them.
Lighting makeLighting(Context& context, const FacetList& facets, const Settings& settings);
void addVolume(Context& context, const FacetList& facets, Lighting& light);
void gather(Frame& frame, const SceneOnDevice& scene, const ShadowMaps& shadows, const FacetList& facets,
            Lighting& light, const Settings& settings);
/// F M by samples of the emitters in place of rays; empty: by rays.
struct EmitterSource {
  const Emitters* emitters = nullptr;
  const Field* field = nullptr;
};
/// Runs sweeps until the bound is met, `maxSweeps` at most; warm start from light.radiosity (from the dark where the
/// last report has something not finite). Blocking.
SolveReport solve(Context& context, const FacetList& facets, const FormFactors& matrix, Lighting& light,
                  const Settings& settings, uint32_t maxSweeps, const EmitterSource& source = {});
/// `blurred` and `blurredEmitted`, with report.blurChange; and the volume where it exists: H, or B with ungated
/// sampling (T 5.9), or B - lambda (M + rho D) with edge removal (T eq. 23), W/m^2 in all cases, the first facet of a
/// voxel, alpha 1. `light` must stay where it is until the frame has finished: light.report.clampedVoxels and
/// blurChange are read back. `watchBlur`: blurChange also where the settings have no blur, without the copies.
void scatter(Frame& frame, const FacetList& facets, Lighting& light, const Settings& settings, bool watchBlur = false);

}  // namespace irad
