// The first gather from emissive facets, F M: one product with the exitance, or samples of the emitters (docs/method.md
// 5).
#include <algorithm>
#include <cmath>

#include "gi/emitter_rule.h"
#include "gi/emitters.h"
#include "gi/facets.h"
#include "gi/gather_emitters.h"
#include "gi/hits_on_host.h"
#include "gi/host_pass.h"
#include "gi/host_trace.h"
#include "gi/lighting.h"
#include "gi/matrix.h"
#include "gi/ray_kernel.h"
#include "gi/subsystems.h"
#include "gi/sweep.h"
#include "renderer/frame/frame.h"
#include "shaders/shared/constants.h"
#include "shaders/shared/solve.h"

namespace irad {
namespace {

constexpr const char* kGatherEmittersStage = "GI Solve Emitters";

/// Whether the emitters are few enough to be low-probability, high-energy (T 5.6).
bool sampleEmitters(const Settings& settings, const EmitterSource& source, uint32_t facets) {
  if (!source.emitters || source.emitters->count == 0 || settings.matrix.gpu.hitRule != HitRule::triangles)
    return false;
  if (settings.matrix.emitterSampling != EffectMode::automatic)
    return settings.matrix.emitterSampling == EffectMode::on;
  return emittersAreFew(source.emitters->count, facets);
}

/// Compares the sums over all facets of F M by samples and by rays, and says whether the samples may stand in.
bool agrees(Context& context, const FormFactors& matrix, const Emitters& emitters, Lighting& light) {
  const auto sampled = downloadAs<glm::vec4>(context, light.emitted);
  const auto correction = downloadAs<glm::vec4>(context, light.correction);
  double bySamples = 0, byRays = 0;
  for (size_t i = 0; i < sampled.size(); ++i) {
    bySamples += luminance(sampled[i]);
    byRays += luminance(sampled[i] - correction[i]);
  }
  const double hits = byRays / emitters.brightest * matrix.rays;  // at least
  light.sampledShare = byRays > 0 ? static_cast<float>(bySamples / byRays) : 0;
  return std::abs(bySamples - byRays) <= byRays * (kEmitterAgreement + 3 / std::sqrt(std::max(hits, 1.0)));
}

/// What `host` finds of the emitters, in place of the kernel's rays.
Buffer sampledByHost(Context& context, const FacetList& facets, const Emitters& emitters, const Settings& settings,
                     const HostTrace& host) {
  const auto table = downloadAs<Emitter>(context, emitters.entries);
  const auto exitance = downloadAs<glm::vec3>(context, facets.emission);
  std::vector<glm::vec4> light(facets.count);
  timedOnHost(context, kGatherEmittersStage, [&] {
    host.emitters({table, emitters.power, exitance, settings.matrix.emitterSamples, settings.matrix.gpu.seed}, light);
  });
  return makeBuffer(context, "emitters' light by the host", Subsystem::Solver, std::span<const glm::vec4>(light));
}

/// light.emitted becomes F M by samples, light.correction what that adds to F M by rays. `byHost`: the samples, if the
/// host has traced them.
void recordSamples(Frame& frame, const FacetList& facets, const FormFactors& matrix, const EmitterSource& source,
                   const Settings& settings, const Buffer& byHost, Lighting& light) {
  const RayKernel kernel = rayKernel(facets, *source.field, settings.matrix.gpu);
  light.correction = Buffer(frame.context().device, "emitters' correction", Subsystem::Solver, 16ull * facets.count);
  Pass pass = frame.pass(kGatherEmittersStage);
  SampleEmittersPush push{};
  push.matrix = pass.in(matrix.record);
  push.facets = pass.in(facets.record);
  push.chebyshev = kernel.chebyshev(pass);
  push.emitters = pass.in(source.emitters->record);
  push.emitted = pass.out(light.emitted);
  push.correction = pass.out(light.correction);
  push.byHost = pass.inIfAny(byHost);
  push.surface = pass.inIfAny(facets.surface.record);
  push.dims = facets.grid.dims;
  push.jfaMax = source.field->jumpFlood.largest;
  push.samples = settings.matrix.emitterSamples;
  push.seed = settings.matrix.gpu.seed;
  kernel.configure(pass, frame.context().device, "gi/sample_emitters")
      .constant(CONSTANT_MATRIX_FORMAT, matrix.format)
      .constant(CONSTANT_BY_HOST, static_cast<bool>(byHost))
      .push(push)
      .dispatch(facets.count);
}

}  // namespace

void gatherEmitters(Context& context, const FacetList& facets, const FormFactors& matrix, const EmitterSource& source,
                    const Settings& settings, Lighting& light) {
  light.correction = Buffer();
  light.sampledShare = 0;
  if (!facets.hasEmission) return;
  Sweep sweep(context, facets, matrix, settings.solver);
  const auto byRays = [&] {
    // M as a vector, in the spare half of B's double buffer; then one product.
    Frame frame = context.begin();
    Pass pass = frame.pass(kGatherEmittersStage);
    pass.shader("gi/emission.comp")
        .push(EmissionPush{pass.in(facets.record), pass.out(light.radiosityNext)})
        .dispatch(facets.count);
    sweep.record(frame, kGatherEmittersStage, SOLVE_PRODUCT, light.radiosityNext, light.emitted, light);
    frame.submitAndWait();
  };
  byRays();
  if (sampleEmitters(settings, source, facets.count)) {
    Buffer byHost;
    if (source.onHost)
      if (const HostTrace* host = hostTraceIfAny(context, facets, settings.matrix.gpu, kGatherEmittersStage))
        byHost = sampledByHost(context, facets, *source.emitters, settings, *host);
    Frame frame = context.begin();
    recordSamples(frame, facets, matrix, source, settings, byHost, light);
    frame.submitAndWait();
    const bool forced = settings.matrix.emitterSampling == EffectMode::on;
    if (!agrees(context, matrix, *source.emitters, light) && !forced) {
      light.correction = Buffer();
      byRays();
    }
  }
}

}  // namespace irad
