#include "renderer/resolve.h"

#include "shaders/shared/constants.h"
#include "shaders/shared/passes.h"

namespace irad {

void listPixels(Frame& frame, const SceneOnDevice& scene, Targets& targets) {
  const auto fit = [&](Buffer& buffer, const char* name, uint64_t bytes) {
    if (buffer.bytes != bytes) buffer = Buffer(frame.context().device, name, Subsystem::Targets, bytes);
  };
  const auto materials = static_cast<uint32_t>(scene.materialValues.size());
  fit(targets.pixelLists, "lists of pixels by material", sizeof(PixelList) * (materials + 1ull));
  fit(targets.listedPixels, "pixels by material", sizeof(glm::uvec2) * targets.size.x * targets.size.y);

  PixelListPush push{};
  push.size = targets.size;
  push.materials = materials;
  const auto overPicture = [&](bool write) {
    Pass pass = frame.pass("RE Forward");
    push.scene = pass.in(scene.record);
    push.visible = pass.in(targets.visible);
    push.lists = pass.out(targets.pixelLists);
    if (write) push.listed = pass.out(targets.listedPixels);
    pass.shader("forward/list_pixels.comp").constant(CONSTANT_LIST_PIXELS, write).push(push).dispatch(targets.size);
  };

  frame.pass("RE Forward").fill(targets.pixelLists, 0);
  overPicture(/*write*/ false);
  Pass place = frame.pass("RE Forward");
  push.scene = 0;
  push.visible = 0;
  push.lists = place.out(targets.pixelLists);
  place.shader("forward/place_lists.comp").push(push).dispatch(materials);
  overPicture(/*write*/ true);
}

}  // namespace irad
