// Voxelization (docs/method.md 2, T 5.1): which triangles own each voxel's facets.
#include "gi/voxelize.h"

#include <algorithm>

#include "gi/grid.h"
#include "gi/scan.h"
#include "gi/settings.h"
#include "gi/subsystems.h"
#include "gi/thesis/literal_grid.h"
#include "gi/thesis/raster_voxels.h"
#include "gi/voxel_pass.h"
#include "renderer/base/error.h"
#include "renderer/gpu_scene.h"
#include "shaders/shared/constants.h"

namespace irad {
namespace {

/// Clips triangles to cells: a workgroup for each tile.
void clipTriangles(Frame& frame, const Voxels& voxels, const std::vector<TriangleRange>& ranges, const Tiles& tiles) {
  for (const bool masked : {false, true}) {
    if (std::ranges::count(ranges, masked, &TriangleRange::masked) == 0) continue;
    Pass pass = frame.pass(kVoxelizeStage);
    VoxelizePush push = voxelizePush(pass, voxels, masked);
    push.tileStart = pass.in(tiles.starts);
    pass.shader("gi/voxelize.comp").run([&](Commands& commands) {
      for (size_t i = 0; i < ranges.size(); ++i) {
        const TriangleRange& range = ranges[i];
        push.tileCount = tiles.bounds[i + 1] - tiles.bounds[i];
        if (range.masked != masked || push.tileCount == 0) continue;
        commands.bindMaterial(voxels.scene->materialSets.at(range.material));
        push.firstTriangle = range.first;
        push.endTriangle = range.end;
        push.firstTile = tiles.bounds[i];
        commands.push(push);
        commands.dispatch(push.tileCount);
      }
    });
  }
}

}  // namespace

std::vector<TriangleRange> triangleRanges(const SceneOnDevice& scene) {
  const uint32_t triangles = scene.scene.triangleCount();
  if (triangles > MAX_TRIANGLES)
    throw InputError(fmt::format("{}: {} triangles; voxelization takes at most {}", scene.scene.path.string(),
                                 triangles, MAX_TRIANGLES));
  std::vector<TriangleRange> ranges;
  bool open = false;  // the last range may grow
  for (const Draw& draw : scene.scene.draws) {
    const bool masked = (scene.materialValues.at(draw.material).flags & MATERIAL_ALPHA_MASK) != 0;
    const TriangleRange range{draw.firstIndex / 3, (draw.firstIndex + draw.indexCount) / 3, draw.material, masked};
    if (open && !masked && ranges.back().end == range.first)
      ranges.back().end = range.end;
    else
      ranges.push_back(range);
    open = !masked;
  }
  return ranges;
}

Tiles countTiles(Context& context, const SceneOnDevice& scene, const Buffer& grid,
                 const std::vector<TriangleRange>& ranges) {
  const uint32_t triangles = scene.scene.triangleCount();
  Tiles tiles;
  tiles.starts = Buffer(context.device, "tile starts", Subsystem::Voxels, 4ull * triangles);
  Buffer total(context.device, "tile total", Subsystem::Voxels, 4);
  Buffer bounds(context.device, "tile bounds", Subsystem::Voxels, 4ull * (ranges.size() + 1), Access::Readback);
  Frame frame = context.begin();
  Pass pass = frame.pass(kVoxelizeStage);
  VoxelizePush push{};
  push.scene = pass.in(scene.record);
  push.grid = pass.in(grid);
  push.tileStart = pass.out(tiles.starts);
  push.endTriangle = triangles;
  pass.shader("gi/voxel_tiles.comp").push(push).dispatch(triangles);
  exclusiveScan(frame, kVoxelizeStage, tiles.starts, triangles, total);
  for (size_t i = 0; i < ranges.size(); ++i)
    frame.pass(kVoxelizeStage).copy(tiles.starts, bounds, 4, 4ull * ranges[i].first, 4 * i);
  frame.pass(kVoxelizeStage).copy(total, bounds, 4, 0, 4 * ranges.size());
  frame.submitAndWait();
  const auto* start = static_cast<const uint32_t*>(bounds.mapped);
  tiles.bounds.assign(start, start + ranges.size() + 1);
  return tiles;
}

VoxelizePush voxelizePush(Pass& pass, const Voxels& voxels, bool masked) {
  pass.constant(CONSTANT_SAMPLES_TEXTURES, masked);
  VoxelizePush push{};
  push.scene = pass.in(voxels.scene->record);
  push.grid = pass.in(voxels.gridRecord);
  push.keys = pass.accumulate(voxels.keys);
  return push;
}

bool rasterizesByKernels(const Device& device, const Settings& settings) {
  if (settings.rasterizer == Rasterizer::kernels && !device.int64Atomics)
    throw UsageError(fmt::format("device.rasterizer=kernels: {} has no 64-bit atomics", device.info.name));
  if (settings.rasterizer == Rasterizer::automatic) return device.narrowGraphics && device.int64Atomics;
  return settings.rasterizer == Rasterizer::kernels;
}

Voxels voxelize(Context& context, const SceneOnDevice& scene, const Settings& settings) {
  const uint32_t triangles = scene.scene.triangleCount();
  Voxels voxels;
  voxels.scene = &scene;
  const auto grid = settings.thesis.literal ? makeLiteralGrid : makeGrid;
  voxels.grid = grid(scene.scene.boundsMin, scene.scene.boundsMax, settings.voxel.resolution);
  voxels.gridRecord = makeBuffer<Grid>(context, "grid", Subsystem::Voxels, std::span(&voxels.grid, 1));
  voxels.keys = Buffer(context.device, "voxel keys", Subsystem::Voxels, 4ull * voxels.grid.voxels);

  const auto ranges = triangles > 0 ? triangleRanges(scene) : std::vector<TriangleRange>{};
  const bool raster = settings.voxel.method == VoxelMethod::raster;
  const Tiles tiles = raster || ranges.empty() ? Tiles{} : countTiles(context, scene, voxels.gridRecord, ranges);
  Frame frame = context.begin();
  frame.pass(kVoxelizeStage).fill(voxels.keys, 0);
  if (raster)
    rasterizeVoxels(frame, voxels, ranges, settings);
  else
    clipTriangles(frame, voxels, ranges, tiles);
  frame.submitAndWait();
  return voxels;
}

}  // namespace irad
