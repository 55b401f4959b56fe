#include "gi/picked.h"

#include "gi/subsystems.h"
#include "shaders/shared/picked.h"

namespace irad {

void pickNone(Frame& frame, const char* stage, const char* name, glm::uvec2 picture, Buffer& list, uint32_t parts) {
  if (!list)
    list = Buffer(frame.context().device, name, Subsystem::Targets,
                  4 * (uint64_t{PICKED_FIRST} + uint64_t{picture.x} * picture.y));
  frame.pass(stage).update(list, glm::uvec4(0, parts, 1, 0));
}

}  // namespace irad
