// Direct light onto the facets (METHOD section 6, T 5.7). M needs no pass: the solver reads it from the facet list.
#include "gi/stages.h"
#include "shaders/shared/solve.h"

namespace irad {

void gather(Frame& frame, const SceneOnDevice& scene, const ShadowMaps& shadows, const FacetList& facets,
            Lighting& light, const Settings& settings) {
  if (facets.count == 0) return;
  GatherPush push{};
  push.scene = scene.record.address;
  push.facets = facets.record.address;
  push.direct = light.direct.address;
  push.origin = facets.grid.origin;
  push.edge = facets.grid.edge;
  push.samples = settings.gather.samples;
  push.shadowBias = settings.camera.gpu.shadowBias;
  push.pcf = settings.camera.gpu.pcf;
  Pass pass = frame.pass("GI Gather");
  pass.shader("gi/gather.comp");
  specialize(pass, GATHER_LIGHTS, kindsOf(scene.shining), scene.shining);
  pass.constant(0, static_cast<uint32_t>(facets.encoding))
      .read(scene.record, scene.shiningLights, facets.record, facets.voxel, facets.shape)
      .write(light.direct);
  sampleShadows(pass, shadows).push(push).dispatch(facets.count);
}

}  // namespace irad
