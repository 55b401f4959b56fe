// Where the light goes: what is emitted against what is absorbed and what escapes.
#pragma once

#include "gi/check/run.h"

namespace irad {

/// Of the red channel; shares of sum A (M + D).
struct EnergyShares {
  double accounted = 0;  ///< (sum A (1 - rho)(D + H) + sum A B (1 - sum_j F_ij)) / sum A (M + D): 1 but for errors
  double escaped = 0;    ///< the part that leaves the scene
};
EnergyShares energyShares(const CheckRun& run, const Pipeline& pipeline);

}  // namespace irad
