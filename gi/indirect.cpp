#include "gi/indirect.h"

#include "shaders/shared/constants.h"
#include "shaders/shared/indirect.h"

namespace irad {
namespace {

/// In compute, where no lane is spent outside a triangle.
void lookUpFacets(Frame& frame, const IndirectInputs& from, const Buffer& camera, bool emitted, Targets& targets) {
  Pass pass = frame.pass("RE Forward");
  IndirectPush push{};
  push.camera = pass.in(camera);
  push.grid = pass.in(*from.grid);
  push.reverse = pass.in(*from.reverse);
  push.voxel = pass.in(*from.voxel);
  push.surface = pass.in(*from.surface);
  push.shaded = pass.in(*from.shaded);
  if (emitted) push.shadedEmitted = pass.in(*from.shadedEmitted);
  push.sampling = from.sample;
  push.size = targets.size;
  pass.shader("gi/indirect_links.comp")
      .constant(CONSTANT_EMITTED, emitted)
      .constant(CONSTANT_KEEPS_POSITION, from.keepPosition)
      .write(targets.indirect)
      .write(targets.linear)
      .write(emitted ? targets.emitted : targets.indirect)
      .push(push)
      .dispatch(targets.size);
}

}  // namespace

void drawScene(Frame& frame, const SceneOnDevice& scene, const ShadowMaps& shadows, const IndirectInputs& indirect,
               const Buffer& camera, const ShadeParams& shade, Targets& targets, const ForwardEffects& effects) {
  const bool wanted = effects.indirect && indirect.grid != nullptr;
  const bool fromVolume = wanted && indirect.volume != nullptr;
  const bool fromFacets = wanted && indirect.surface != nullptr && indirect.shaded != nullptr;
  const bool emitted = fromFacets && effects.emission && indirect.shadedEmitted != nullptr;
  ForwardEffects drawn = effects;
  drawn.indirect = fromVolume || fromFacets;
  targets.fit(frame.context(), &Targets::emitted, emitted);
  const VolumeLookup lookup{fromVolume ? indirect.volume : nullptr, indirect.grid, indirect.sample};
  drawForward(frame, scene, shadows, camera, shade, targets, drawn, lookup);
  if (fromFacets) lookUpFacets(frame, indirect, camera, emitted, targets);
}

}  // namespace irad
