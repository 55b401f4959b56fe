#include "gi/thesis/raster_voxels.h"

#include <algorithm>

#include "gi/subsystems.h"
#include "gi/voxelize.h"
#include "renderer/raster.h"

namespace irad {

void rasterizeVoxels(Frame& frame, const Voxels& voxels, std::vector<TriangleRange> ranges, const Settings& settings) {
  const SceneOnDevice& scene = *voxels.scene;
  const Device& device = frame.context().device;
  const uint32_t triangles = scene.scene.triangleCount();
  if (triangles == 0) return;
  const uint32_t size = std::max({voxels.grid.dims.x, voxels.grid.dims.y, voxels.grid.dims.z});
  const bool kernels = rasterizesByKernels(device, settings);
  Buffer queue;
  if (kernels) {
    // A kernel skips masked triangles by itself, so all the others are one range.
    std::erase_if(ranges, [](const TriangleRange& range) { return !range.masked; });
    ranges.push_back({0, triangles, 0, /*masked*/ false});
    queue = makeRasterQueue(device, Subsystem::Voxels, triangles);
  }
  const auto count = [&](bool masked) { return std::ranges::count(ranges, masked, &TriangleRange::masked); };

  VoxelizePush push{};
  const auto eachRange = [&](Commands& commands, bool masked, const auto& go) {
    for (const TriangleRange& range : ranges) {
      if (range.masked != masked) continue;
      commands.bindMaterial(scene.materialSets.at(range.material));
      push.firstTriangle = range.first;
      push.endTriangle = range.end;
      commands.push(push);
      go(range.end - range.first, range.first);
    }
  };
  if (kernels) {
    rasterize(
        frame, kVoxelizeStage, "thesis/voxel_raster.comp", queue, count(true) > 0,
        [&](Pass& pass, RasterStep step, uint64_t queued) {
          push = voxelizePush(pass, voxels, step.masked);
          push.tileStart = queued;
          push.tileCount = rasterQueuePieces(triangles);
        },
        [&](Commands& commands, RasterStep step) {
          eachRange(commands, step.masked, [&](uint32_t drawn, uint32_t) {
            rasterDispatch(commands, step, drawn, static_cast<uint32_t>(count(step.masked)));
          });
        });
    return;
  }
  for (const bool masked : {false, true}) {
    if (count(masked) == 0) continue;
    Pass pass = frame.pass(kVoxelizeStage);
    push = voxelizePush(pass, voxels, masked);
    pass.shaders({"thesis/voxel_raster.vert", "thesis/voxel_raster.frag"})
        .extent(size, size)
        .run([&](Commands& commands) {
          eachRange(commands, masked, [&](uint32_t drawn, uint32_t first) { commands.draw(3 * drawn, 3 * first); });
        });
  }
}

}  // namespace irad
