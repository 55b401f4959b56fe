// The buffers of light per facet.
#include "gi/lighting.h"

#include "gi/acceleration.h"
#include "gi/facets.h"
#include "gi/settings.h"
#include "gi/subsystems.h"
#include "gi/thesis/volume.h"
#include "renderer/frame/frame.h"
#include "shaders/shared/solve.h"

namespace irad {

Lighting makeLighting(Context& context, const FacetList& facets, const Settings& settings) {
  const uint64_t bytes = 16ull * facets.count;
  const Device& device = context.device;
  Lighting light;
  light.gain = {settings.solver.gpu.lambda, settings.solver.gpu.lambda};
  light.direct = Buffer(device, "direct irradiance D", Subsystem::Solver, bytes);
  if (facets.hasEmission) light.emitted = Buffer(device, "emitted share F M", Subsystem::Solver, bytes);
  light.indirect = Buffer(device, "indirect irradiance H", Subsystem::Solver, bytes);
  light.radiosity = Buffer(device, "radiosity B (a)", Subsystem::Solver, bytes);
  light.radiosityNext = Buffer(device, "radiosity B (b)", Subsystem::Solver, bytes);
  light.residual = Buffer(device, "solver residual", Subsystem::Solver, sizeof(SolveResidual) * SOLVE_RESIDUALS);
  const bool framewise = settings.solver.method == SolverMethod::bruteForce;
  FrameMean& mean = light.frameMean;
  if (framewise) {
    mean.next = Buffer(device, "radiosity B of the next frame", Subsystem::Solver, bytes);
    mean.standardError = Buffer(device, "standard error of H", Subsystem::Solver, bytes);
  } else {
    light.rowSum = Buffer(device, "row sums of F", Subsystem::Solver, 4ull * facets.count);
  }
  makeHistory(context, facets, light, !framewise && settings.solver.acceleration != SolverAcceleration::off);
  Frame frame = context.begin();
  for (const Buffer* b : {&light.direct, &light.emitted, &light.indirect, &light.radiosity, &light.radiosityNext,
                          &light.residual, &light.rowSum, &mean.next, &mean.standardError})
    if (*b) frame.pass("GI Solve Clear").fill(*b, 0);
  frame.submit();
  if (settings.matrix.gpu.hitRule == HitRule::thesis) light.volume = makeVolume(context, facets.grid);
  return light;
}

void fitEmitted(Context& context, const FacetList& facets, Lighting& light) {
  light.emitted = Buffer();
  if (!facets.hasEmission) return;
  light.emitted = Buffer(context.device, "emitted share F M", Subsystem::Solver, 16ull * facets.count);
  Frame frame = context.begin();
  frame.pass("GI Solve Clear").fill(light.emitted, 0);
  frame.submit();
}

}  // namespace irad
