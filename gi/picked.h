// Lists of pixels that kernels are dispatched over (shaders/shared/picked.h).
#pragma once

#include "renderer/frame/frame.h"

namespace irad {

/// Makes `list` where it is not there yet, with room for a whole picture, and leaves it empty. `parts`: workgroups that
/// share a group of its pixels, in y.
void pickNone(Frame& frame, const char* stage, const char* name, glm::uvec2 picture, Buffer& list, uint32_t parts = 1);

}  // namespace irad
