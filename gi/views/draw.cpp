// Draws a view: its own passes, its range, and the display picture.
#include <cmath>

#include "gi/facets.h"
#include "gi/settings.h"
#include "gi/views/fields.h"
#include "gi/views/passes.h"
#include "renderer/frame/frame.h"
#include "renderer/targets.h"
#include "shaders/shared/constants.h"
#include "shaders/shared/view.h"

namespace irad {

float linearExposure(const Settings& settings) {
  return settings.camera.gpu.exposure * std::exp2(settings.camera.exposureEv);
}

bool exposesItself(const ViewInfo& info, const Settings& settings) {
  return info.toneMapped() && settings.camera.autoExposure;
}

void drawTargets(Frame& frame, View view, const ViewInputs& inputs, const Buffer& camera, const Settings& settings,
                 Targets& targets) {
  const ViewInfo* info = viewInfo(view);
  const Buffer* sky = inputs.sky;
  Pass pass = frame.pass("View");
  ViewPush push{};
  push.camera = pass.in(camera);
  if (sky != nullptr) push.sky = pass.in(*sky);
  push.kind = info != nullptr ? info->kind : VIEW_KIND_COLOR;
  push.linearOnly = info != nullptr && (info->hasRange() || exposesItself(*info, settings)) ? 1 : 0;
  push.exposure = linearExposure(settings);
  push.toneCurve = settings.camera.gpu.toneCurve;
  if (inputs.facets != nullptr) {
    push.origin = inputs.facets->grid.origin;
    push.inverseEdge = inputs.facets->grid.inverseEdge;
  }
  push.writeback = settings.writeback.gpu;
  pass.shader("view/debug_view.comp")
      .constant(CONSTANT_VIEW, view)
      .constant(CONSTANT_SKY, sky != nullptr)
      .constant(CONSTANT_TARGETS, targets.present())
      .sample(targets.depth, pointSampler(frame.context().device))
      .read(targets.normal, targets.geometric, targets.albedo, targets.direct, targets.bound(&Targets::highlight),
            targets.bound(&Targets::indirect), targets.bound(&Targets::emitted), targets.bound(&Targets::specular))
      .write(targets.linear, targets.display)
      .push(push)
      .dispatch(targets.size);
}

void drawView(Frame& frame, View view, const ViewInputs& inputs, const Buffer& camera, const Settings& settings,
              Targets& targets) {
  const ViewInfo* known = viewInfo(view);
  if (inputs.fields != nullptr && (known == nullptr || !known->isFrom(FROM_ANY_FIELD | FROM_MATRIX_ROW)))
    *inputs.fields = {};  // no memory for what is not shown
  if (known == nullptr) return drawTargets(frame, view, inputs, camera, settings, targets);

  const ViewInfo& info = *known;
  const bool needsRange = info.hasRange() || exposesItself(info, settings);
  if (info.shape) {
    drawVoxels(frame, info, inputs, camera, settings, targets);
  } else if (info.isFrom(FROM_PICTURE)) {
    if (info.isFrom(FROM_TARGETS) && !inputs.composed)
      drawTargets(frame, inputs.pictureOf, inputs, camera, settings, targets);
    drawReference(frame, info, inputs, targets);
  } else if (info.isFrom(FROM_SHADOW_MAPS)) {
    drawShadowView(frame, info, inputs, camera, settings, targets);
  } else if (info.isFrom(FROM_FACETS)) {
    drawPinHoles(frame, inputs, camera, targets);
  } else {
    if (!inputs.composed) drawTargets(frame, view, inputs, camera, settings, targets);
    if (!needsRange && !inputs.composed) return;  // the display picture is there
  }
  if (needsRange) {
    if (inputs.range != nullptr)
      frame.pass("View range").copy(*inputs.range, targets.viewRange, sizeof(ViewRange));
    else
      findRange(frame, info, settings, targets);
  }
  finishView(frame, info, settings, inputs.facets != nullptr ? inputs.facets->grid.dims : glm::uvec3(1), targets);
}

}  // namespace irad
