// Direct light onto the facets (docs/method.md 6, T 5.7). M needs no pass: the solver reads it from the facet list.
#include "gi/gather.h"

#include "gi/facets.h"
#include "gi/lighting.h"
#include "gi/settings.h"
#include "renderer/frame/frame.h"
#include "renderer/gpu_scene.h"
#include "renderer/shadow.h"
#include "shaders/shared/constants.h"
#include "shaders/shared/solve.h"

namespace irad {

void gather(Frame& frame, const SceneOnDevice& scene, const ShadowMaps& shadows, const FacetList& facets,
            Lighting& light, const Settings& settings) {
  if (facets.count == 0) return;
  Pass pass = frame.pass("GI Gather");
  GatherPush push{};
  push.scene = pass.in(scene.record);
  push.facets = pass.in(facets.record);
  push.surface = pass.inIfAny(facets.surface.record);
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

}  // namespace irad
