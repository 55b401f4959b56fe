// One Jacobi sweep: on the device by the kernel that suits it (shaders/gi/solve*.comp), or by the host.
#pragma once

#include "gi/settings.h"

namespace irad {

class Buffer;
class Context;
class Frame;
struct FacetList;
struct FormFactors;
struct Lighting;
struct SolvePush;

/// Binds the kernel to a list and a matrix, which it must not outlive.
class Sweep {
 public:
  Sweep(Context& context, const FacetList& facets, const FormFactors& matrix, const SolverSettings& settings);

  /// `work`: SOLVE_SWEEP, SOLVE_WATCH, SOLVE_GAINS or SOLVE_PRODUCT of shared/solve.h. `record`: of light.residual,
  /// where it is watched. The host sweeps at once, in the middle of the frame (gi/host_pass.h).
  void record(Frame& frame, const char* stage, uint32_t work, const Buffer& input, const Buffer& output,
              const Lighting& light, uint32_t record = 0);

  float omega, flush;  ///< of the sweeps recorded next: relaxation; W/m^2 below which light is put out

 private:
  /// What the rows take and give. `pass`: a Pass, or a HostPass.
  template <class AnyPass>
  SolvePush rowsToSum(AnyPass& pass, uint32_t work, const Buffer& input, const Buffer& output, const Lighting& light,
                      uint32_t record) const;
  void sweepByHost(Frame& frame, const char* stage, uint32_t work, const Buffer& input, const Buffer& output,
                   const Lighting& light, uint32_t record) const;

  const FacetList& facets_;
  const FormFactors& matrix_;
  float lambda_;
  SolverKernel kernel_;  ///< of all work but SOLVE_GAINS, which the thesis's does not do
  SolverKernel gains_;
  bool onHost_ = false;  ///< gi/sweep_on_host.h
};

}  // namespace irad
