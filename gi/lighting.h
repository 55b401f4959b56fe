// Light per facet, and what a solve reports of it (docs/method.md 6, T 5.7-5.9).
#pragma once

#include <limits>
#include <optional>

#include "gi/facets.h"

namespace irad {

/// The first wrong number: of the earliest stage whose product holds one, the facet of the lowest index.
struct Defect {
  const char* stage;     ///< docs/method.md 11: "GI Gather"
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
  float bound = 0;     ///< q/(1-q) max|dB|: error bound on B (docs/method.md 1), W/m^2
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
  /// Further sweeps would not improve anything.
  bool settled() const { return converged || diverging || nonFinite > 0; }
};
/// The factor on the sources in stored light: solver.lambda as it was when the light was solved, not as it is set now.
/// B holds radiosity x (M + rho D); H, one product behind, holds indirect x F M.
struct SourceGain {
  float radiosity = 1, indirect = 1;
};
/// Steps in where the residual grows. What a sweep multiplies B by, A = lambda rho F, has no negative entry: its
/// spectral radius r is an eigenvalue (Perron), which a damped sweep turns into 1 - omega + omega r, below 1 only where
/// r is. Damping therefore mends no true divergence; but where a row gain exceeds 1 and r does not, the residual may
/// grow for a while, and damping tells the two apart before B has grown far.
struct DivergenceGuard {
  static constexpr uint32_t kPatience = 5;  ///< growing sweeps in a row before it halves omega, then gives up
  float lambda = 0, asked = 0;              ///< the settings that it was begun with
  float omega = 1;                          ///< in use
  float step = std::numeric_limits<float>::infinity();  ///< max |dB| / omega: what the last sweep would change undamped
  float growth = 0;                                     ///< of `step`, as a factor
  uint32_t growing = 0;
  bool damped = false, gaveUp = false;
  Buffer radiosity, indirect;  ///< B and H from before, where lambda lets them diverge
  SourceGain gain;             ///< theirs
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
  /// Sum of F M by samples over that by rays; 0: not sampled. Far from 1 the samples are not used
  /// (gather_emitters.cpp).
  float sampledShare = 0;
  Buffer indirect;                  ///< H
  Buffer radiosity, radiosityNext;  ///< B, double buffer
  SourceGain gain;                  ///< of B and H; for light that is 0 any value is right
  Buffer blurred;         ///< H averaged over neighbours that face the same way; none where shading samples H itself
  Buffer blurredEmitted;  ///< `emitted` likewise
  Buffer blurChange;      ///< largest |blurred - H|, float bits; where scatter() watches it
  Image volume;           ///< RGBA16F: the thesis's RadianceTexture (only for ungated sampling, views and exports)
  Buffer residual;        ///< solver's reductions, see shared/solve.h
  Buffer rowSum;          ///< sum_j F_ij, one float each
  Buffer clamped;         ///< counter of the volume's clamped voxels; with the volume
  SolveReport report;
  DivergenceGuard guard;
  /// What shading samples, H and F M, blurred or not.
  const Buffer& shaded() const { return blurred ? blurred : indirect; }
  const Buffer& shadedEmitted() const { return blurred ? blurredEmitted : emitted; }
  /// False: there is no light and nothing is stored of it; every value is 0.
  explicit operator bool() const { return static_cast<bool>(radiosity); }
  /// Largest H while sources last shone, W/m^2: in the dark, light below 1e-6 of it is put out; reflections of less
  /// than specular.threshold of it are not traced.
  float litH = 0;
};
/// All zero. The volume exists when sampling is ungated; addVolume (gi/thesis/volume.h) makes it otherwise. Blurred
/// copies exist where scatter() blurs, which makes and frees them.
Lighting makeLighting(Context& context, const FacetList& facets, const Settings& settings);

}  // namespace irad
