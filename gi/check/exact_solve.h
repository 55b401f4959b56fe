// The light that a pipeline's matrix stands for, in double precision on the host: the truth that its solver is held to.
#pragma once

#include <functional>
#include <glm/glm.hpp>
#include <vector>

namespace irad {

class Context;
class Pipeline;

struct ExactLight {
  std::vector<glm::dvec3> indirect, radiosity;  ///< H and B of each facet, W/m^2
  double meanH = 0;                             ///< over the facets' areas, of the brightest channel
  double bound = 0;                             ///< error of B, and so of H, W/m^2
  uint32_t sweeps = 0;
  /// H by reflections: [k] is what comes after k of them, the first so many terms of the sum that H is; D, which has
  /// none, apart.
  std::vector<std::vector<glm::dvec3>> bounces;
};
/// Solves H = F B + S, B = lambda (M + W + rho (D + H)), with the rows, sources and albedos as the pipeline holds them,
/// by Gauss-Seidel sweeps, of long lists in blocks that threads share, until `bound` is at most `tolerance` x meanH.
/// WorkError where row gains reach 1, and where the roundings of double precision keep it from that. The pipeline has a
/// matrix and light. `progress` may be empty; where it returns false a WorkError ends the solve. `bounces`: how many
/// ExactLight::bounces there are to be.
ExactLight solveExactly(Context& context, const Pipeline& pipeline, double tolerance,
                        const std::function<bool(float)>& progress = {}, uint32_t bounces = 0);

}  // namespace irad
