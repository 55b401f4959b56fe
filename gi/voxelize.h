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

/// Per voxel and facet slot: which triangle won (ordered atomic key), and its attributes.
struct Voxels {
  Grid grid;
  Buffer gridRecord;                     ///< one Grid
  uint32_t slots = 1;                    ///< facets of a voxel that were looked for
  Buffer keys;                           ///< slots x voxels uints, the keys of shared/voxelize.h; 0: empty
  const SceneOnDevice* scene = nullptr;  ///< compactFacets reads the winners' attributes from it
};
Voxels voxelize(Context& context, const SceneOnDevice& scene, const Settings& settings);

}  // namespace irad
