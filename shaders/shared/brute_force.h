// Brute force (docs/method.md 9): H as the mean of what the rays of many frames bring.
#ifndef IRAD_SHARED_BRUTE_FORCE_H
#define IRAD_SHARED_BRUTE_FORCE_H
#include "shared/sky.h"
#include "shared/solve.h"
IRAD_BEGIN

/// gi/brute_force.comp: what the rays of some facets have met in one frame, into the mean over the frames. W/m^2.
struct BruteForcePush {
  FacetRecord facets;
  UintArray hits;            ///< `rays` words per facet from firstFacet on, as gi/trace_*_rays.comp writes them
  Vec4Array bins;            ///< mean radiance of the sky by bins, where there is one
  Vec4Array direct;          ///< D
  Vec4Array from, to;        ///< B that the rays of this frame bring; and B for those of the next
  Vec4Array indirect;        ///< mean H
  Vec4Array emitted;         ///< mean F M, where facets emit
  Vec4Array radiosity;       ///< B of the mean H
  Vec4Array standardError;   ///< of the mean H; w: mean share of the rays that meet a facet
  ResidualArray residual;    ///< without maxDelta, maxRise, maxFall and maxReach
  uint firstFacet, count;    ///< this dispatch's facets
  uint rays;                 ///< per facet; 0: nothing is brought, and B for the first frame is lambda (M + rho D)
  float lambda, omega, flush;
  float share;       ///< of the mean, that this frame has; 1 for the first
  float toVariance;  ///< squared standard error of the mean so far -> weighted variance of the frames so far
  float toError;     ///< weighted variance of the frames, this one included -> squared standard error
};

IRAD_END
#endif
