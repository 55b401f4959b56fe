// "RE Emitters": light straight from emissive triangles, looked for by each pixel (shaders/gi/emitters_light.comp).
#include "gi/pixel_emitters.h"

#include "shaders/shared/pixel_emitters.h"

#include "gi/facets.h"
#include "gi/lighting.h"
#include "gi/ray_kernel.h"
#include "gi/subsystems.h"
#include "gi/traits.h"
#include "gi/views/draw.h"
#include "renderer/frame/frame.h"
#include "renderer/gpu_scene.h"
#include "renderer/targets.h"
#include "shaders/shared/constants.h"

namespace irad {

EmissiveTriangles listEmissiveTriangles(Context& context, const SceneOnDevice& scene,
                                        std::span<const MaterialTraits> materials, const FacetList& facets,
                                        const Buffer& grid) {
  EmissiveTriangles out;
  if (!facets.hasEmission || facets.count == 0) return out;
  const auto emits = [&](const Draw& draw) { return materials[draw.material].emission > 0; };  // as the plan counts
  for (const Draw& draw : scene.scene.draws)
    if (emits(draw)) out.count += draw.indexCount / 3;
  if (out.count > MAX_EMISSIVE_TRIANGLES) out.count = 0;
  if (out.count == 0) return out;

  out.triangles =
      Buffer(context.device, "emissive triangles", Subsystem::Specular, sizeof(EmissiveTriangle) * out.count);
  Frame frame = context.begin();
  Pass pass = frame.pass("GI CompactList");
  EmissiveTrianglesPush push{};
  push.scene = pass.in(scene.record);
  push.grid = pass.in(grid);
  push.triangles = pass.out(out.triangles);
  push.corners = pass.inIfAny(facets.surface.corners);
  push.hasCorners = static_cast<bool>(facets.surface.corners);
  pass.shader("gi/emissive_triangles.comp").constant(CONSTANT_SAMPLES_TEXTURES, true).run([&](Commands& commands) {
    for (const Draw& draw : scene.scene.draws) {
      if (!emits(draw)) continue;
      push.first = draw.firstIndex / 3;
      push.count = draw.indexCount / 3;
      commands.bindMaterial(scene.materialSets.at(draw.material));
      commands.push(push);
      commands.dispatch(push.count);
      push.place += push.count;
    }
  });
  frame.submit();
  return out;
}

void lightByEmitters(Frame& frame, const ViewInputs& inputs, const Settings& settings, Targets& targets) {
  const bool looks = inputs.emissiveTriangles != nullptr && inputs.emissiveTriangles->count > 0 && targets.emitted &&
                     inputs.facets != nullptr && inputs.field != nullptr && inputs.lighting != nullptr;
  targets.fit(frame.context(), &Targets::seen, looks);
  if (!looks) return;
  const FacetList& facets = *inputs.facets;
  const Field& field = *inputs.field;
  const EmissiveTriangles& emissive = *inputs.emissiveTriangles;
  const RayKernel kernel{field.chebyshev ? TRACE_SKIP : TRACE_DDA_REVERSE, settings.matrix.gpu.hitRule, facets.encoding,
                         facets, field};
  PixelEmittersPush push{};
  push.grid = facets.grid;
  push.count = emissive.count;
  push.rays = settings.sample.emitterRays;
  push.gain = inputs.lighting->gain.indirect;
  push.size = targets.size;
  push.everywhere = settings.sample.emitters == EmitterLookup::pixels;
  Pass seen = frame.pass("RE Emitters");
  push.facets = seen.in(facets.record);
  push.surface = seen.inIfAny(facets.surface.record);
  push.chebyshev = kernel.chebyshev(seen);
  push.triangles = seen.in(emissive.triangles);
  kernel.configure(seen, frame.context().device, "gi/emitters_seen")
      .read(targets.linear, targets.normal, targets.geometric, targets.emitted)
      .write(targets.seen)
      .push(push)
      .dispatch(targets.size);
  Pass light = frame.pass("RE Emitters");
  push.facets = 0;
  push.surface = 0;
  push.chebyshev = 0;
  push.triangles = light.in(emissive.triangles);
  light.shader("gi/emitters_light.comp")
      .read(targets.linear, targets.normal, targets.geometric, targets.seen)
      .write(targets.indirect, targets.emitted)
      .push(push)
      .dispatch(targets.size);
}

}  // namespace irad
