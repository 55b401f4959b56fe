// Views of pictures that others made: the lights' shadow maps, and the reference picture.
#include "gi/view_passes.h"
#include "shaders/shared/view.h"

namespace irad {
namespace {

void groups(Commands& commands, const Targets& targets) {
  commands.dispatchGroups((targets.size.x + 7) / 8, (targets.size.y + 7) / 8);
}

}  // namespace

void drawShadowView(Frame& frame, View view, const ViewInputs& inputs, const Buffer& camera, const Settings& settings,
                    Targets& targets) {
  const uint32_t light = settings.view.light;
  if (inputs.scene == nullptr || inputs.shadows == nullptr || light >= inputs.scene->lightValues.size() ||
      inputs.scene->lightValues[light].shadowLayer < 0)
    return frame.pass("View").clear(targets.linear, ClearColor{});
  ShadowViewPush push{};
  push.lights = inputs.scene->lights.address;
  push.camera = camera.address;
  push.light = light;
  push.size = targets.size;
  push.shadowBias = settings.camera.gpu.shadowBias;
  push.pcf = settings.camera.gpu.pcf;
  const VkSampler point = pointSampler(frame.context().device);
  Pass pass = frame.pass("View");
  pass.shader(view == VIEW_SHADOW ? "view/shadow.comp" : "view/shadow_map.comp").read(camera, inputs.scene->lights);
  if (view == VIEW_SHADOW)
    sampleShadows(pass, *inputs.shadows).sample(targets.depth, point).read(targets.geometric);
  else
    pass.sampleDepth(inputs.shadows->flat, point, /*cube*/ false)
        .sampleDepth(inputs.shadows->cubes, point, /*cube*/ true);
  pass.write(targets.linear).push(push).run([&](Commands& commands) { groups(commands, targets); });
}

void drawReference(Frame& frame, View view, const ViewInputs& inputs, Targets& targets) {
  if (inputs.picture == nullptr) return frame.pass("View").clear(targets.linear, ClearColor{});
  SamplerDesc linear{Wrap::Clamp, Wrap::Clamp};
  linear.mips = linear.linearMips = false;
  ReferencePush push{};
  push.size = targets.size;
  push.referenceSize = {inputs.picture->desc.width, inputs.picture->desc.height};
  frame.pass("View")
      .shader("view/reference.comp")
      .constant(0, view)
      .sample(*inputs.picture, sampler(frame.context().device, linear))
      .write(targets.linear)
      .push(push)
      .run([&](Commands& commands) { groups(commands, targets); });
}

}  // namespace irad
