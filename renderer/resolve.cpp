#include "renderer/resolve.h"

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
  push.scene = scene.record.address;
  push.visible = targets.visible.address;
  push.lists = targets.pixelLists.address;
  push.listed = targets.listedPixels.address;
  push.size = targets.size;
  push.materials = materials;
  const auto overPicture = [&](bool write) {
    Pass pass = frame.pass("RE Forward");
    pass.shader("forward/list_pixels.comp")
        .constant(0, write)
        .read(scene.record, scene.triangleMaterials, targets.visible)
        .write(targets.pixelLists);
    if (write) pass.write(targets.listedPixels);
    pass.push(push).run(
        [&](Commands& commands) { commands.dispatchGroups((targets.size.x + 15) / 16, (targets.size.y + 15) / 16); });
  };

  frame.pass("RE Forward").fill(targets.pixelLists, 0);
  overPicture(/*write*/ false);
  frame.pass("RE Forward").shader("forward/place_lists.comp").write(targets.pixelLists).push(push).dispatch(materials);
  overPicture(/*write*/ true);
}

}  // namespace irad
