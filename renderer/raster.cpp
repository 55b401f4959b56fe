#include "renderer/raster.h"

#include <algorithm>

#include "renderer/targets.h"
#include "shaders/shared/raster.h"

namespace irad {

static_assert(sizeof(RasterPiece) == RASTER_PIECE_BYTES);

uint32_t rasterQueuePieces(uint32_t triangles) {
  return triangles + triangles / 2 + 1024;  // a clipped triangle may come to several
}
uint64_t rasterQueueBytes(uint32_t triangles) {
  return RASTER_COUNTS_BYTES + 2 * rasterPartBytes(rasterQueuePieces(triangles));
}
Buffer makeRasterQueue(const Device& device, Subsystem subsystem, uint32_t triangles) {
  return Buffer(device, "large triangles", subsystem, rasterQueueBytes(triangles));
}

void rasterize(Frame& frame, const char* stage, std::string_view shader, const Buffer& queue, bool anyMasked,
               const std::function<void(Pass&, RasterStep)>& declare,
               const std::function<void(Commands&, RasterStep)>& body) {
  frame.pass(stage).update(queue, std::array<uint32_t, RASTER_COUNTS_BYTES / 4>{});
  for (const bool tiles : {false, true})
    for (const bool masked : {false, true}) {
      if (masked && !anyMasked) continue;
      const RasterStep step{tiles, masked};
      Pass pass = frame.pass(stage);
      pass.shader(shader).constant(RASTER_TILES, tiles);
      if (tiles)
        pass.read(queue);
      else
        pass.accumulate(queue);
      declare(pass, step);
      pass.run([&](Commands& commands) { body(commands, step); });
    }
}

void rasterDispatch(Commands& commands, RasterStep step, uint32_t triangles, uint32_t dispatches) {
  if (step.tiles)
    commands.dispatchGroups(std::max(RASTER_GROUPS / dispatches, 64u));
  else
    commands.dispatch(triangles);
}

void rasterScene(Frame& frame, const SceneOnDevice& scene, const RasterPass& raster) {
  const uint32_t triangles = scene.scene.triangleCount();
  if (triangles == 0) return;
  const auto masked = [&](const Draw& draw) {
    return raster.alphaTest && (scene.materialValues.at(draw.material).flags & MATERIAL_ALPHA_MASK) != 0;
  };
  RasterPush push{};
  push.scene = scene.record.address;
  push.projection = raster.projections.address + raster.offset;
  push.queue = raster.queue.address;
  push.target = raster.target.address + raster.targetOffset;
  push.size = raster.size;
  push.pieces = rasterQueuePieces(triangles);
  push.cull = raster.cull;
  const auto dispatches = static_cast<uint32_t>(std::ranges::count_if(scene.scene.draws, masked));
  const auto declare = [&](Pass& pass, RasterStep step) {
    pass.constant(RASTER_MASKED, step.masked)
        .read(scene.record, scene.positions, scene.indices, scene.triangleMaterials, scene.materials,
              raster.projections)
        .accumulate(raster.target);
    if (step.masked) pass.read(scene.uv0, scene.uv1, scene.colors);
  };
  rasterize(frame, raster.stage, raster.shader, raster.queue, dispatches > 0, declare,
            [&](Commands& commands, RasterStep step) {
              const auto draw = [&](size_t material, uint32_t first, uint32_t end, uint32_t of) {
                push.first = first;
                push.end = end;
                commands.bindMaterial(scene.materialSets.at(material));
                commands.push(push);
                rasterDispatch(commands, step, end - first, of);
              };
              push.skipMasked = !step.masked && raster.alphaTest;
              if (!step.masked) return draw(0, 0, triangles, 1);
              for (const Draw& d : scene.scene.draws)
                if (masked(d)) draw(d.material, d.firstIndex / 3, (d.firstIndex + d.indexCount) / 3, dispatches);
            });
}

void rasterVisible(Frame& frame, const SceneOnDevice& scene, const Buffer& camera, bool alphaTest, Targets& targets) {
  constexpr const char* kStage = "RE Depth";
  frame.pass(kStage).fill(targets.visible, ~0u);
  rasterScene(frame, scene,
              {.stage = kStage,
               .shader = "raster/visible.comp",
               .projections = camera,
               .target = targets.visible,
               .size = targets.size,
               .queue = targets.rasterQueue,
               .cull = true,
               .alphaTest = alphaTest});
  frame.pass(kStage)
      .shader("raster/store_depth.comp")
      .read(targets.visible)
      .write(targets.depth)
      .push(targets.visible.address)
      .dispatchGroups((targets.size.x + 15) / 16, (targets.size.y + 15) / 16);
}

}  // namespace irad
