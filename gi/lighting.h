// Light per facet (docs/method.md 6, T 5.7-5.9).
#pragma once

#include <array>
#include <cstdint>
#include <limits>

#include "gi/brute_force.h"
#include "gi/solve_report.h"
#include "gi/thesis/volume.h"
#include "gi/writeback.h"
#include "renderer/resources.h"

namespace irad {

class Context;
struct FacetList;
struct Settings;

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
/// What solver.method = brute_force keeps from frame to frame (gi/brute_force.h). With a matrix it has no buffers.
struct FrameMean {
  FrameWeights weights;
  Buffer next;           ///< beside Lighting::radiosityNext: B that the rays of one frame bring, and those of the next
  Buffer standardError;  ///< of H; w: share of the rays that meet a facet
  Buffer hits;           ///< scratch, while frames are traced
  double meanH = 0;      ///< after the last frame, W/m^2
  /// What shading sampled before an edit of light, and goes on to sample for the first frames after it.
  Buffer held, heldEmitted;
  uint32_t heldFor = 0;  ///< frames
};
/// Per-facet light, fp32 vec4 (xyz; w is used in B alone): W/m^2.
struct Lighting {
  Buffer direct;  ///< D
  /// F M: first gather from emissive facets alone (the part of H that is direct light of emitters). None where nothing
  /// emits. w: variance of what samples of the emitters bring, were they independent, the channels together; or 0.
  Buffer emitted;
  Buffer correction;  ///< what samples of the emitters add to F M by rays; none where they are not sampled
  /// Sum of F M by samples over that by rays; 0: not sampled. Far from 1 the samples are not used
  /// (gather_emitters.cpp).
  float sampledShare = 0;
  Buffer sky;                       ///< the part of H that comes straight from the sky (w: gather_sky.comp); or none
  Writeback writeback;              ///< W: reflections as a source; nothing where they are not written back
  Buffer indirect;                  ///< H
  Buffer radiosity, radiosityNext;  ///< B, double buffer; w: v, the gains' answer (docs/method.md 1)
  std::array<Buffer, 3> history;    ///< B of earlier sweeps, where they are accelerated
  SourceGain gain;                  ///< of B and H; for light that is 0 any value is right
  Buffer blurred;  ///< H averaged over linked facets as far as its noise goes; none where shading samples H itself
  Buffer blurredEmitted;  ///< `emitted` likewise
  Buffer blurChange;      ///< the most that the blur changes H by, float bits; where scatter() watches it
  Buffer residual;        ///< solver's reductions, see shared/solve.h: a record per sweep of a batch
  Buffer sums;            ///< gi/solve_sums.comp's
  Buffer rowSum;          ///< sum_j F_ij, one float each; none without a matrix
  RadianceVolume volume;  ///< only with the thesis's hit rule
  FrameMean frameMean;
  SolveReport report;
  DivergenceGuard guard;
  /// What shading samples, H and F M, blurred or not.
  const Buffer& shaded() const { return frameMean.held ? frameMean.held : blurred ? blurred : indirect; }
  const Buffer& shadedEmitted() const {
    return frameMean.heldEmitted ? frameMean.heldEmitted : blurred ? blurredEmitted : emitted;
  }
  /// False: there is no light and nothing is stored of it; every value is 0.
  explicit operator bool() const { return static_cast<bool>(radiosity); }
  /// Largest H while sources last shone, W/m^2: in the dark, light below 1e-6 of it is put out; reflections of less
  /// than specular.threshold of it are not traced.
  float litH = 0;
};
/// All zero, with what solver.method needs. Blurred copies exist where scatter() blurs, which makes and frees them.
Lighting makeLighting(Context& context, const FacetList& facets, const Settings& settings);
/// Makes room for F M, all zero, where facets have come to emit, and frees it where they no longer do. For light of a
/// matrix; the next gatherEmitters() and scatter() fit the rest.
void fitEmitted(Context& context, const FacetList& facets, Lighting& light);

}  // namespace irad
