// voxel.method=raster (docs/method.md 2, T 5.1.2): each triangle is drawn along its dominant axis.
#pragma once

#include <vector>

#include "gi/voxel_pass.h"
#include "renderer/frame/frame.h"

namespace irad {

struct Settings;

/// Fills the keys of `voxels`, by the graphics pipeline or by kernels, which produce the same fragments. `ranges`: all
/// of the scene's.
void rasterizeVoxels(Frame& frame, const Voxels& voxels, std::vector<TriangleRange> ranges, const Settings& settings);

}  // namespace irad
