// Anderson acceleration of the sweeps (docs/method.md 1): after a few of them their results are mixed, so that the mix
// of their residuals is as small as may be.
#pragma once

#include <array>
#include <cstdint>
#include <span>

#include "renderer/resources.h"
#include "shaders/shared/solve.h"

namespace irad {

class Context;
class Frame;
struct FacetList;
struct Lighting;

/// Sums over all facets of products of residuals, by component: of r_a r_b, b <= a, at a (a + 1)/2 + b.
using ResidualProducts = std::array<glm::dvec4, SOLVE_VECTORS*(SOLVE_VECTORS + 1) / 2>;

/// Weights with the sum 1 that make |sum_j weight_j r_j|^2 least, of `count` residuals whose products are component
/// `component` of `products`. Where there is nothing to choose: the last residual alone.
std::array<double, SOLVE_VECTORS> leastResidual(const ResidualProducts& products, uint32_t count, int component);

/// The buffers that acceleration and its sums need, in `light`.
void makeHistory(Context& context, const FacetList& facets, Lighting& light, bool accelerated);

/// What the host learns of the light after a batch of sweeps.
struct SweepSums {
  double meanH = 0;  ///< of the colour channel where it is largest, by the facets' areas; W/m^2
  ResidualProducts products{};
};

/// Records the mean of |values| over the facets' areas, of the colour channel where it is largest, with `sums` as
/// scratch; `mean` is written when it is there. The same bits in every run.
void recordMean(Frame& frame, const char* stage, const FacetList& facets, const Buffer& values, const Buffer& sums,
                double& mean);

/// The sweeps since the light was last mixed.
class Acceleration {
 public:
  Acceleration(Context& context, const FacetList& facets, Lighting& light, bool on)
      : context_(context), facets_(facets), light_(light), on_(on) {}

  /// Sweeps until it is time to mix.
  uint32_t left() const { return SOLVE_VECTORS - swept_; }
  bool on() const { return on_; }
  /// After a sweep from radiosityNext to radiosity: keeps what it began with. `gains`: it iterated the gains' answer.
  void keep(bool gains);
  /// Records the sums of the light as it is, and with `mixing` those that mix() needs; `sums` is read when they are
  /// there.
  void recordSums(Frame& frame, const char* stage, bool mixing, SweepSums& sums);
  /// Mixes where that leaves a smaller residual than `residual`, the last sweep's: the residual of the mix, which is in
  /// radiosity then, or 0. The history ends.
  float mix(const char* stage, const SweepSums& sums, float residual);
  void forget() { swept_ = 0, reachKept_ = true; }
  bool ready() const { return on_ && swept_ >= 2; }

 private:
  std::array<const Buffer*, SOLVE_VECTORS + 1> vectors() const;
  Context& context_;
  const FacetList& facets_;
  Lighting& light_;
  bool on_;
  uint32_t swept_ = 0;
  bool reachKept_ = true;  ///< every sweep since iterated the gains' answer
};

}  // namespace irad
