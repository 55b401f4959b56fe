#include "gi/thesis/mask_writeback.h"

#include "gi/writeback.h"
#include "gi/writeback_pass.h"
#include "renderer/frame/frame.h"
#include "renderer/targets.h"

namespace irad {

void storeSelected(const WritebackPicture& picture) {
  const Targets& targets = picture.targets;
  const bool kernels = static_cast<bool>(targets.visible);
  Pass pass = picture.frame.pass(kWritebackStage);
  if (kernels)
    pass.shader("thesis/writeback_mask.comp");
  else
    pass.shaders({"thesis/screen.vert", "thesis/writeback_mask.frag"});
  readReflections(picture, pass).write(picture.inputs.written->stored).push(writebackPush(picture, pass));
  if (kernels)
    pass.dispatch(targets.size);
  else
    pass.extent(targets.size.x, targets.size.y).draw(3);
}

}  // namespace irad
