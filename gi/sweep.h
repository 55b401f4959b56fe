// One Jacobi sweep on the device (shaders/gi/solve*.comp), by the kernel that suits it.
#pragma once

#include <array>

#include "gi/settings.h"
#include "renderer/resources.h"

namespace irad {

class Context;
class Frame;
struct FacetList;
struct FormFactors;
struct Lighting;

/// Binds the kernel to a list and a matrix, which it must not outlive.
class Sweep {
 public:
  Sweep(Context& context, const FacetList& facets, const FormFactors& matrix, const SolverSettings& settings);

  /// Before the first record(): `input` is what it will be called with. Later ones take their predecessor's output.
  void begin(Frame& frame, const char* stage, const Buffer& input);
  /// `work`: SOLVE_SWEEP, SOLVE_WATCH, SOLVE_GAINS or SOLVE_PRODUCT of shared/solve.h. `record`: of light.residual,
  /// where it is watched.
  void record(Frame& frame, const char* stage, uint32_t work, const Buffer& input, const Buffer& output,
              const Lighting& light, uint32_t record = 0);

  float omega, flush;  ///< of the sweeps recorded next: relaxation; W/m^2 below which light is put out

 private:
  const FacetList& facets_;
  const FormFactors& matrix_;
  float lambda_;
  SolverKernel kernel_;  ///< of all work but SOLVE_GAINS, which the thesis's does not do
  SolverKernel gains_;
  bool images_ = false;           ///< the vectors as images too, see gi/solve.glsl
  std::array<Image, 2> vectors_;  ///< input and output, in turn
  uint32_t current_ = 0;
};

}  // namespace irad
