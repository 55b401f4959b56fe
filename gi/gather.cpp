// Direct light onto the facets (docs/method.md 6, T 5.7). M needs no pass: the solver reads it from the facet list.
#include "gi/gather.h"

#include "gi/facets.h"
#include "gi/field.h"
#include "gi/hits_on_host.h"
#include "gi/host_pass.h"
#include "gi/host_trace.h"
#include "gi/lighting.h"
#include "gi/ray_kernel.h"
#include "gi/settings.h"
#include "renderer/frame/frame.h"
#include "renderer/gpu_scene.h"
#include "renderer/shadow.h"
#include "shaders/shared/constants.h"
#include "shaders/shared/solve.h"

namespace irad {
namespace {

constexpr const char* kGatherStage = "GI Gather";

/// By rays past the triangles.
void gatherSurfels(Frame& frame, const SceneOnDevice& scene, const FacetList& facets, const Field& field,
                   Lighting& light) {
  Pass pass = frame.pass(kGatherStage);
  GatherSurfelsPush push{};
  push.scene = pass.in(scene.record);
  push.facets = facets.arrays([&](const Buffer& buffer) { return pass.in(buffer); });
  push.surface = pass.in(facets.surface.record);
  push.chebyshev = pass.inIfAny(field.chebyshev);
  push.direct = pass.out(light.direct);
  push.origin = facets.grid.origin;
  push.edge = facets.grid.edge;
  push.dims = facets.grid.dims;
  mayMeet(pass.shader("gi/gather_surfels.comp"), facets).constant(CONSTANT_TRACE_METHOD, exactTraversal(field));
  specialize(pass, GATHER_LIGHTS, kindsOf(scene.shining), scene.shining);
  pass.push(push).dispatch(uint64_t{facets.count} * FACET_SURFELS);
}

/// By the host's rays.
void gatherOnHost(Context& context, const SceneOnDevice& scene, const FacetList& facets, const HostTrace& host,
                  Lighting& light) {
  timedOnHost(context, kGatherStage, [&] {
    std::vector<glm::vec4> direct(facets.count);
    host.direct(scene.shining, direct);
    upload(context, light.direct, std::as_bytes(std::span(direct)));
  });
}

/// Through the shadow maps.
void gatherPlanes(Frame& frame, const SceneOnDevice& scene, const ShadowMaps& shadows, const FacetList& facets,
                  Lighting& light, const Settings& settings) {
  Pass pass = frame.pass(kGatherStage);
  GatherPush push{};
  push.scene = pass.in(scene.record);
  push.facets = pass.in(facets.record);
  push.direct = pass.out(light.direct);
  push.origin = facets.grid.origin;
  push.edge = facets.grid.edge;
  push.shadowBias = settings.camera.gpu.shadowBias;
  push.pcf = settings.camera.gpu.pcf;
  pass.shader("gi/gather.comp");
  specialize(pass, GATHER_LIGHTS, kindsOf(scene.shining), scene.shining);
  pass.constant(CONSTANT_NORMALS, facets.encoding);
  sampleShadows(pass, shadows).push(push).dispatch(facets.count);
}

}  // namespace

void gather(Frame& frame, const SceneOnDevice& scene, const ShadowMaps& shadows, const FacetList& facets,
            const Field& field, Lighting& light, const Settings& settings, bool onHost) {
  if (facets.count == 0) return;
  const HostTrace* host = onHost ? hostTraceIfAny(frame.context(), facets, settings.matrix.gpu, kGatherStage) : nullptr;
  if (host != nullptr)
    gatherOnHost(frame.context(), scene, facets, *host, light);
  else if (facets.surface)
    gatherSurfels(frame, scene, facets, field, light);
  else
    gatherPlanes(frame, scene, shadows, facets, light, settings);
}

}  // namespace irad
