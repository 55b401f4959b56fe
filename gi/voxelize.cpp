// Voxelization (METHOD section 2, T 5.1): which triangle owns each voxel, and which one faces against it.
#include <algorithm>

#include "gi/stages.h"
#include "renderer/error.h"
#include "renderer/raster.h"
#include "shaders/shared/voxelize.h"

namespace irad {
namespace {

constexpr const char* kStage = "GI Voxelization";
constexpr uint32_t kSamplesTextures = 0;  // specialization constant of shaders/gi/voxel_material.glsl

/// Triangles that one dispatch or draw takes: a masked material by itself, with its textures; all between together.
struct Range {
  uint32_t first, end;  // triangles
  uint32_t material;    // whose set is bound
  bool masked;          // its alpha decides
  uint32_t firstTile = 0, tiles = 0;
};

std::vector<Range> triangleRanges(const SceneOnDevice& scene) {
  std::vector<Range> ranges;
  bool open = false;  // the last range may grow
  for (const Draw& draw : scene.scene.draws) {
    const bool masked = (scene.materialValues.at(draw.material).flags & MATERIAL_ALPHA_MASK) != 0;
    const Range range{draw.firstIndex / 3, (draw.firstIndex + draw.indexCount) / 3, draw.material, masked};
    if (open && !masked && ranges.back().end == range.first)
      ranges.back().end = range.end;
    else
      ranges.push_back(range);
    open = !masked;
  }
  return ranges;
}

/// Counts the tiles of every triangle and reads back where each range's tiles start.
Buffer countTiles(Context& context, const SceneOnDevice& scene, const VoxelizePush& base, const Voxels& voxels,
                  std::vector<Range>& ranges) {
  const uint32_t triangles = scene.scene.triangleCount();
  Buffer starts(context.device, "tile starts", Subsystem::Voxels, 4ull * triangles);
  Buffer total(context.device, "tile total", Subsystem::Voxels, 4);
  Buffer bounds(context.device, "tile bounds", Subsystem::Voxels, 4ull * (ranges.size() + 1), Access::Readback);
  VoxelizePush push = base;
  push.tileStart = starts.address;
  push.endTriangle = triangles;
  Frame frame = context.begin();
  frame.pass(kStage)
      .shader("gi/voxel_tiles.comp")
      .read(scene.record, scene.positions, scene.indices, voxels.gridRecord)
      .write(starts)
      .push(push)
      .dispatch(triangles);
  exclusiveScan(frame, kStage, starts, triangles, total);
  for (size_t i = 0; i < ranges.size(); ++i) frame.pass(kStage).copy(starts, bounds, 4, 4ull * ranges[i].first, 4 * i);
  frame.pass(kStage).copy(total, bounds, 4, 0, 4 * ranges.size());
  frame.submitAndWait();
  const auto* start = static_cast<const uint32_t*>(bounds.mapped);
  for (size_t i = 0; i < ranges.size(); ++i) {
    ranges[i].firstTile = start[i];
    ranges[i].tiles = start[i + 1] - start[i];
  }
  return starts;
}

}  // namespace

bool rasterizesByKernels(const Device& device, const Settings& settings) {
  if (settings.rasterizer == Rasterizer::kernels && !device.int64Atomics)
    throw UsageError(fmt::format("device.rasterizer=kernels: {} has no 64-bit atomics", device.info.name));
  if (settings.rasterizer == Rasterizer::automatic) return device.narrowGraphics && device.int64Atomics;
  return settings.rasterizer == Rasterizer::kernels;
}

Voxels voxelize(Context& context, const SceneOnDevice& scene, const Settings& settings) {
  const uint32_t triangles = scene.scene.triangleCount();
  if (triangles > MAX_TRIANGLES)
    throw InputError(fmt::format("{}: {} triangles; voxelization takes at most {}", scene.scene.path.string(),
                                 triangles, MAX_TRIANGLES));
  Voxels voxels;
  voxels.scene = &scene;
  voxels.slots = settings.effects.secondFacet == EffectMode::off ? 1 : settings.voxel.facets;
  const auto grid = settings.thesis.literal ? makeLiteralGrid : makeGrid;
  voxels.grid = grid(scene.scene.boundsMin, scene.scene.boundsMax, settings.voxel.resolution);
  voxels.gridRecord = makeBuffer<Grid>(context, "grid", Subsystem::Voxels, std::span(&voxels.grid, 1));
  voxels.keys = Buffer(context.device, "voxel keys", Subsystem::Voxels, 4ull * voxels.slots * voxels.grid.voxels);

  VoxelizePush push{};
  push.scene = scene.record.address;
  push.grid = voxels.gridRecord.address;
  push.keys = voxels.keys.address;
  push.slots = settings.voxel.facets;
  std::vector<Range> ranges = triangles > 0 ? triangleRanges(scene) : std::vector<Range>{};
  const bool raster = settings.voxel.method == VoxelMethod::raster;
  Buffer tileStarts;
  if (!raster && !ranges.empty()) tileStarts = countTiles(context, scene, push, voxels, ranges);
  push.tileStart = tileStarts.address;

  const bool kernels = raster && triangles > 0 && rasterizesByKernels(context.device, settings);
  const uint32_t size = std::max({voxels.grid.dims.x, voxels.grid.dims.y, voxels.grid.dims.z});
  Buffer queue;
  if (kernels) {
    // A kernel passes over what is masked by itself: all the others are one range.
    std::erase_if(ranges, [](const Range& range) { return !range.masked; });
    ranges.push_back({0, triangles, 0, /*masked*/ false});
    queue = makeRasterQueue(context.device, Subsystem::Voxels, triangles);
    push.tileStart = queue.address;
  }

  Frame frame = context.begin();
  frame.pass(kStage).fill(voxels.keys, 0);
  for (push.slot = 0; push.slot < voxels.slots; ++push.slot) {
    const auto count = [&](bool masked) { return std::ranges::count(ranges, masked, &Range::masked); };
    const auto declare = [&](Pass& pass, bool masked) {
      pass.read(scene.record, scene.positions, scene.indices, scene.triangleMaterials, scene.materials, scene.uv0,
                scene.uv1, scene.colors, voxels.gridRecord)
          .constant(kSamplesTextures, masked);
      if (push.slot == 0)
        pass.accumulate(voxels.keys);
      else
        pass.write(voxels.keys);  // reads those of the slots before
    };
    const auto eachRange = [&](Commands& commands, bool masked, const auto& go) {
      for (const Range& range : ranges) {
        if (range.masked != masked) continue;
        commands.bindMaterial(scene.materialSets.at(range.material));
        push.firstTriangle = range.first;
        push.endTriangle = range.end;
        push.firstTile = range.firstTile;
        push.tileCount = kernels ? rasterQueuePieces(triangles) : range.tiles;
        commands.push(push);
        go(range);
      }
    };
    if (kernels) {
      rasterize(
          frame, kStage, "gi/voxel_raster.comp", queue, count(true) > 0,
          [&](Pass& pass, RasterStep step) { declare(pass, step.masked); },
          [&](Commands& commands, RasterStep step) {
            eachRange(commands, step.masked, [&](const Range& r) {
              rasterDispatch(commands, step, r.end - r.first, static_cast<uint32_t>(count(step.masked)));
            });
          });
      continue;
    }
    for (const bool masked : {false, true}) {
      if (count(masked) == 0) continue;
      Pass pass = frame.pass(kStage);
      declare(pass, masked);
      if (raster)
        pass.shaders({"gi/voxel_raster.vert", "gi/voxel_raster.frag"}).extent(size, size);
      else
        pass.shader("gi/voxelize.comp").read(tileStarts);
      pass.run([&](Commands& commands) {
        eachRange(commands, masked, [&](const Range& range) {
          if (raster)
            commands.draw(3 * (range.end - range.first), 3 * range.first);
          else if (range.tiles > 0)
            commands.dispatch(range.tiles);
        });
      });
    }
  }
  frame.submitAndWait();
  return voxels;
}

}  // namespace irad
