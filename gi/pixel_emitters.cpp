// "RE Emitters": light straight from emissive triangles, looked for by each pixel (shaders/gi/emitters_light.comp).
#include "shaders/shared/pixel_emitters.h"

#include "gi/ray_kernel.h"
#include "gi/traits.h"
#include "gi/views.h"

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

  constexpr uint32_t kSamplesTextures = 0;  // specialization constant of shaders/gi/voxel_material.glsl
  out.triangles =
      Buffer(context.device, "emissive triangles", Subsystem::Specular, sizeof(EmissiveTriangle) * out.count);
  EmissiveTrianglesPush push{};
  push.scene = scene.record.address;
  push.grid = grid.address;
  push.triangles = out.triangles.address;
  Frame frame = context.begin();
  frame.pass("GI CompactList")
      .shader("gi/emissive_triangles.comp")
      .constant(kSamplesTextures, true)
      .read(scene.record, scene.positions, scene.indices, scene.triangleMaterials, scene.materials, scene.uv0,
            scene.uv1, scene.colors, grid)
      .write(out.triangles)
      .run([&](Commands& commands) {
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
                     inputs.facets != nullptr && inputs.field != nullptr;
  targets.fit(frame.context(), &Targets::seen, looks);
  if (!looks) return;
  const FacetList& facets = *inputs.facets;
  const Field& field = *inputs.field;
  const EmissiveTriangles& emissive = *inputs.emissiveTriangles;
  const RayKernel kernel{field.chebyshev ? TRACE_SKIP : TRACE_DDA_REVERSE, settings.matrix.gpu.hitRule,
                         static_cast<uint32_t>(facets.encoding), facets, field};
  PixelEmittersPush push{};
  push.grid = facets.grid;
  push.facets = facets.record.address;
  push.chebyshev = kernel.chebyshev();
  push.triangles = emissive.triangles.address;
  push.count = emissive.count;
  push.rays = settings.sample.emitterRays;
  push.lambda = settings.solver.gpu.lambda;
  push.size = targets.size;
  const glm::uvec2 groups = (targets.size + 7u) / 8u;
  Pass seen = frame.pass("RE Emitters");
  kernel.configure(seen, frame.context().device, "emitters_seen")
      .read(facets.record, facets.emission, emissive.triangles)
      .read(targets.linear, targets.normal, targets.geometric)
      .write(targets.seen)
      .push(push)
      .dispatchGroups(groups.x, groups.y);
  frame.pass("RE Emitters")
      .shader("gi/emitters_light.comp")
      .read(emissive.triangles, targets.linear, targets.normal, targets.geometric, targets.seen)
      .write(targets.indirect, targets.emitted)
      .push(push)
      .dispatchGroups(groups.x, groups.y);
}

}  // namespace irad
