// What a solve reports, as plain numbers (docs/method.md 6).
#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <limits>
#include <optional>

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
  glm::dvec3 entering{0};  ///< sum of A (M + D + what comes from the sky)
  glm::dvec3 absorbed{0};  ///< sum of A (1 - rho) (D + H)
  glm::dvec3 escaped{0};   ///< sum of A B (1 - sum_j F_ij)
  /// (absorbed + escaped - entering) / entering of the channel where it is largest; 0 in the dark.
  double imbalance() const;
};
struct SolveReport {
  uint32_t sweeps = 0;  ///< of the last call; brute force: frames
  float residual = 0;   ///< max |dB| of the last sweep; brute force: change of the mean H; W/m^2
  float bound = 0;      ///< (kappa/omega - 1) max|dB|: error bound on B (docs/method.md 1), W/m^2
  float allowed = 0;    ///< bound at which the solver sleeps, W/m^2
  float largestH = 0;
  float meanH = 0;                                       ///< by the facets' areas, of the brightest channel
  float kappa = std::numeric_limits<float>::infinity();  ///< the largest value of the gains' answer is at most this
  float kappaSlack = std::numeric_limits<float>::infinity();  ///< and at least kappa / kappaSlack
  float contraction = 0;            ///< of the residual by a sweep, as last seen; 0: not seen yet
  float largestGain = 0;            ///< rho-bar: largest row gain
  uint32_t nonFinite = 0, nan = 0;  ///< components of B that are NaN or infinite; of those, NaN
  uint32_t negative = 0;            ///< components of M + rho D, H or B, and row sums, below zero
  bool dark = false;                ///< nothing shone in the last sweep
  bool converged = false;
  uint32_t frames = 0;  ///< brute force alone: frames in the mean
  float standardError =
      0;  ///< brute force alone: of H, the mean over the facets' areas, of the brightest channel; W/m^2
  bool atMostFrames = false;  ///< brute force has its solver.frames
  bool diverging =
      false;            ///< growing under any relaxation (solver.lambda too large): stopped, the light before is back
  bool damped = false;  ///< the guard took omega below solver.omega
  float omega = 1;      ///< relaxation of the last sweep
  float growth = 0;     ///< of the residual in the last sweep, as a factor, where it may grow (largestGain >= 1)
  std::optional<Defect> defect;         ///< with nonFinite or negative
  std::optional<EnergyBalance> energy;  ///< of a converged solve with solver.lambda 1; by brute force none under a sky,
                                        ///< and none where panes tint, which absorb what no row tells
  std::optional<float> blurChange;  ///< by scatter(), where it watches the blur: the most that it changes H by, W/m^2
  uint32_t clampedVoxels = 0;       ///< by scatter(): whose light exceeds the 65504 W/m^2 that the volume holds
  /// Further sweeps would not improve anything.
  bool settled() const { return converged || atMostFrames || diverging || nonFinite > 0; }
};

}  // namespace irad
