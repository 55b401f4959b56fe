// Views of pictures that others made: the lights' shadow maps, and the reference picture.
#include "gi/settings.h"
#include "gi/views/passes.h"
#include "renderer/frame/frame.h"
#include "renderer/gpu_scene.h"
#include "renderer/shadow.h"
#include "renderer/targets.h"
#include "shaders/shared/constants.h"
#include "shaders/shared/view.h"

namespace irad {
void drawShadowView(Frame& frame, const ViewInfo& info, const ViewInputs& inputs, const Buffer& camera,
                    const Settings& settings, Targets& targets) {
  const uint32_t light = settings.view.light;
  if (inputs.scene == nullptr || inputs.shadows == nullptr || light >= inputs.scene->lightValues.size() ||
      inputs.scene->lightValues[light].shadowLayer < 0)
    return frame.pass("View").clear(targets.linear, ClearColor{});
  Pass pass = frame.pass("View");
  ShadowViewPush push{};
  push.lights = pass.in(inputs.scene->lights);
  push.camera = pass.in(camera);
  push.light = light;
  push.size = targets.size;
  push.shadowBias = settings.camera.gpu.shadowBias;
  push.pcf = settings.camera.gpu.pcf;
  const VkSampler point = pointSampler(frame.context().device);
  pass.shader(info.isFrom(FROM_TARGETS) ? "view/shadow.comp" : "view/shadow_map.comp");
  if (info.isFrom(FROM_TARGETS))
    sampleShadows(pass, *inputs.shadows).sample(targets.depth, point).read(targets.geometric);
  else
    pass.sampleDepth(inputs.shadows->flat, point, /*cube*/ false)
        .sampleDepth(inputs.shadows->cubes, point, /*cube*/ true);
  pass.write(targets.linear).push(push).dispatch(targets.size);
}

void drawReference(Frame& frame, const ViewInfo& info, const ViewInputs& inputs, Targets& targets) {
  if (inputs.picture == nullptr) return frame.pass("View").clear(targets.linear, ClearColor{});
  SamplerDesc linear{Wrap::Clamp, Wrap::Clamp};
  linear.mips = linear.linearMips = false;
  ReferencePush push{};
  push.size = targets.size;
  push.referenceSize = {inputs.picture->desc.width, inputs.picture->desc.height};
  frame.pass("View")
      .shader("view/reference.comp")
      .constant(CONSTANT_VIEW, info.view)
      .sample(*inputs.picture, sampler(frame.context().device, linear))
      .write(targets.linear)
      .push(push)
      .dispatch(targets.size);
}

}  // namespace irad
