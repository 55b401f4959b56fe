// Voxelization: which triangles own which voxels (docs/method.md 2, T 5.1).
#pragma once

#include "renderer/resources.h"
#include "shaders/shared/grid.h"

namespace irad {

class Context;
class SceneOnDevice;
struct Settings;

/// Who rasterizes (renderer/raster.h). UsageError where kernels are asked for that the device cannot run.
bool rasterizesByKernels(const Device& device, const Settings& settings);

/// Per voxel which triangle won, for the thesis's hit rule.
struct Voxels {
  Grid grid;
  Buffer gridRecord;                     ///< one Grid
  Buffer keys;                           ///< the keys of shared/voxelize.h; 0: empty
  const SceneOnDevice* scene = nullptr;  ///< compactFacets reads the winners' attributes from it
};
Voxels voxelize(Context& context, const SceneOnDevice& scene, const Settings& settings);

}  // namespace irad
