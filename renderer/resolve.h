// Where kernels rasterize, the visible pixels are listed by material for shading: a kernel has the textures of one
// material at a time.
#pragma once

#include "renderer/frame/frame.h"
#include "renderer/gpu_scene.h"
#include "renderer/targets.h"

namespace irad {

/// "RE Forward": from targets.visible the lists in targets.pixelLists, element `material` of which starts with dispatch
/// arguments for forward/resolve.comp. Makes both buffers.
void listPixels(Frame& frame, const SceneOnDevice& scene, Targets& targets);

}  // namespace irad
