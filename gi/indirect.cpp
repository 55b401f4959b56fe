#include "gi/indirect.h"

#include "gi/facets.h"
#include "gi/field.h"
#include "gi/picked.h"
#include "gi/ray_kernel.h"
#include "gi/subsystems.h"
#include "gi/views/passes.h"
#include "renderer/shadow.h"
#include "shaders/shared/constants.h"
#include "shaders/shared/indirect.h"
#include "shaders/shared/passes.h"
#include "shaders/shared/solve.h"

namespace irad {
namespace {

constexpr const char* kForwardStage = "RE Forward";

/// Invocations that share the search for a pixel's facet. A CPU has no more of them than cores: what some would look at
/// in vain is work for all.
uint32_t soughtLanes(const Device& device) {
  return device.isCpu ? 1 : 32;
}

/// In compute, where no lane is spent outside a triangle.
void lookUpFacets(Frame& frame, const IndirectInputs& from, const Buffer& camera, bool emitted, bool lights,
                  Targets& targets) {
  const uint32_t lanes = from.searchers > 0 ? from.searchers : soughtLanes(frame.context().device);
  pickNone(frame, kForwardStage, "pixels whose facet is sought", targets.size, targets.sought, lanes);
  const uint32_t parts = lanes > 1 ? 1 : SOUGHT_PARTS;
  if (parts > 1)
    pickNone(frame, kForwardStage, "pixels whose facet is sought around", targets.size, targets.soughtAround);
  if (lights) pickNone(frame, kForwardStage, "pixels whose light is doubted", targets.size, targets.doubted);
  // First all pixels, then, in one part or several, those whose facet is not found at once.
  for (uint32_t step = 0; step <= parts; ++step) {
    if (step == 1 + SOUGHT_OWN) continue;
    const bool seeks = step > 0;
    Pass pass = frame.pass(kForwardStage);
    IndirectPush push{};
    push.camera = pass.in(camera);
    push.grid = pass.in(*from.grid);
    push.reverse = pass.in(from.facets->reverse);
    push.voxel = pass.in(from.facets->voxel);
    push.surface = pass.in(from.facets->surface.record);
    push.shaded = pass.in(*from.shaded);
    if (emitted) push.shadedEmitted = pass.in(*from.shadedEmitted);
    const Buffer& list = step > 1 ? targets.soughtAround : targets.sought;
    push.sought = seeks ? pass.in(list) : pass.out(list);
    if (step == 1 && parts > 1) push.soughtAround = pass.out(targets.soughtAround);
    if (lights) {
      push.direct = pass.in(*from.direct);
      push.doubted = pass.out(targets.doubted);
    }
    if (targets.facet) push.facet = pass.out(targets.facet);
    push.sampling = from.sample;
    push.size = targets.size;
    push.part = seeks ? step - 1 : 0;
    pass.shader("gi/indirect_links.comp")
        .constant(CONSTANT_EMITTED, emitted)
        .constant(CONSTANT_KEEPS_POSITION, from.keepPosition)
        .constant(CONSTANT_SEEKS, seeks)
        .constant(CONSTANT_SOUGHT_LANES, lanes)
        .write(targets.indirect)
        .write(targets.linear)
        .write(emitted ? targets.emitted : targets.indirect)
        .read(targets.direct)
        .push(push);
    if (seeks)
      pass.dispatchIndirect(list);
    else
      pass.dispatch(targets.size);
  }
}

/// gi/direct_seen.comp.
void checkDirect(Frame& frame, const SceneOnDevice& scene, const IndirectInputs& from, const Buffer& camera,
                 Targets& targets) {
  Pass pass = frame.pass(kForwardStage);
  DirectSeenPush push{};
  push.camera = pass.in(camera);
  push.scene = pass.in(scene.record);
  push.facets = from.facets->arrays([&](const Buffer& buffer) { return pass.in(buffer); });
  push.surface = pass.in(from.facets->surface.record);
  push.chebyshev = pass.inIfAny(from.field->chebyshev);
  push.origin = from.facets->grid.origin;
  push.edge = from.facets->grid.edge;
  push.dims = from.facets->grid.dims;
  push.doubted = pass.in(targets.doubted);
  mayMeet(pass.shader("gi/direct_seen.comp"), *from.facets)
      .constant(CONSTANT_TRACE_METHOD, exactTraversal(*from.field))
      .constant(CONSTANT_TARGETS, targets.present() & TARGET_HIGHLIGHT);
  specialize(pass, GATHER_LIGHTS, kindsOf(scene.shining), scene.shining);
  pass.read(targets.indirect)
      .write(targets.direct)
      .write(targets.bound(&Targets::highlight))
      .sample(targets.depth, pointSampler(frame.context().device))
      .push(push)
      .dispatchIndirect(targets.doubted);
}

}  // namespace

void drawScene(Frame& frame, const SceneOnDevice& scene, const ShadowMaps& shadows, const IndirectInputs& indirect,
               const Buffer& camera, const ShadeParams& shade, Targets& targets, const ForwardEffects& effects) {
  const bool wanted = effects.indirect && indirect.grid != nullptr;
  const bool fromVolume = wanted && indirect.volume != nullptr;
  const bool fromFacets = wanted && indirect.facets->surface && indirect.shaded != nullptr;
  const bool emitted = fromFacets && effects.emission && indirect.shadedEmitted != nullptr;
  ForwardEffects drawn = effects;
  drawn.indirect = fromVolume || fromFacets;
  targets.fit(frame.context(), &Targets::emitted, emitted);
  const VolumeLookup lookup{fromVolume ? indirect.volume : nullptr, indirect.grid, indirect.sample};
  drawForward(frame, scene, shadows, camera, shade, targets, drawn, lookup);
  const bool lights = fromFacets && indirect.direct != nullptr && !scene.shining.empty();
  if (!fromFacets) {
    targets.sought = Buffer();
    targets.soughtAround = Buffer();
  }
  if (!lights) targets.doubted = Buffer();
  if (const bool keeps = fromFacets && indirect.keepFacet; keeps != static_cast<bool>(targets.facet))
    targets.facet = keeps ? Buffer(frame.context().device, "facets of pixels", Subsystem::Targets,
                                   4ull * targets.size.x * targets.size.y)
                          : Buffer();
  if (!fromFacets) return;
  if (!effects.wanted.surfaces || !effects.wanted.indirect) return;
  lookUpFacets(frame, indirect, camera, emitted, lights && effects.wanted.direct, targets);
  if (lights && effects.wanted.direct) checkDirect(frame, scene, indirect, camera, targets);
}

}  // namespace irad
