// What the passes of the writeback record, by the mean of a facet's pixels (gi/writeback.cpp) or by the thesis's mask
// (gi/thesis/mask_writeback.cpp).
#pragma once

#include "gi/views/draw.h"
#include "shaders/shared/writeback.h"

namespace irad {

class Pass;

inline constexpr const char *kWritebackStage = "GI Writeback", *kWritebackClear = "GI Writeback Clear";

/// A picture whose reflections are written back.
struct WritebackPicture {
  Frame& frame;
  const ViewInputs& inputs;
  const Buffer& camera;
  const Settings& settings;
  const Targets& targets;
};
/// What shaders with specular/writeback_pixel.glsl are pushed, and their images.
WritebackPush writebackPush(const WritebackPicture& picture, Pass& pass);
Pass& readReflections(const WritebackPicture& picture, Pass& pass);

}  // namespace irad
