#include "renderer/raster.h"

#include "renderer/targets.h"
#include "shaders/shared/raster.h"

namespace irad {

static_assert(sizeof(RasterPiece) == RASTER_PIECE_BYTES);

uint32_t rasterQueuePieces(uint32_t triangles) {
  return triangles + triangles / 2 + 1024;  // a clipped triangle may come to several
}
uint64_t rasterQueueBytes(uint32_t triangles) {
  const uint64_t pieces = rasterQueuePieces(triangles);
  return sizeof(RasterPiece) * (1 + pieces) + sizeof(RasterRest) * pieces;
}
Buffer makeRasterQueue(const Device& device, Subsystem subsystem, uint32_t triangles) {
  return Buffer(device, "large triangles", subsystem, rasterQueueBytes(triangles));
}

void rasterize(Frame& frame, const char* stage, std::string_view shader, const Buffer& queue,
               const std::function<void(Pass&)>& declare, const std::function<void(Commands&, bool tiles)>& body) {
  frame.pass(stage).update(queue, glm::uvec3(0));
  for (const bool tiles : {false, true}) {
    Pass pass = frame.pass(stage);
    pass.shader(shader).constant(RASTER_TILES, tiles).write(queue);
    declare(pass);
    pass.run([&](Commands& commands) { body(commands, tiles); });
  }
}

void rasterDispatch(Commands& commands, bool tiles, uint32_t triangles, uint32_t dispatches) {
  if (tiles)
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
  const auto declare = [&](bool alpha) {
    return [&, alpha](Pass& pass) {
      pass.constant(RASTER_MASKED, alpha)
          .read(scene.record, scene.positions, scene.indices, scene.triangleMaterials, scene.materials,
                raster.projections)
          .write(raster.target);
      if (alpha) pass.read(scene.uv0, scene.uv1, scene.colors);
    };
  };
  const auto draw = [&](Commands& commands, bool tiles, size_t material, uint32_t first, uint32_t end,
                        uint32_t dispatches) {
    push.first = first;
    push.end = end;
    commands.bindMaterial(scene.materialSets.at(material));
    commands.push(push);
    rasterDispatch(commands, tiles, end - first, dispatches);
  };

  push.skipMasked = raster.alphaTest;
  rasterize(frame, raster.stage, raster.shader, raster.queue, declare(false),
            [&](Commands& commands, bool tiles) { draw(commands, tiles, 0, 0, triangles, 1); });
  const auto count = static_cast<uint32_t>(std::count_if(scene.scene.draws.begin(), scene.scene.draws.end(), masked));
  if (count == 0) return;
  push.skipMasked = 0;
  rasterize(frame, raster.stage, raster.shader, raster.queue, declare(true), [&](Commands& commands, bool tiles) {
    for (const Draw& d : scene.scene.draws)
      if (masked(d)) draw(commands, tiles, d.material, d.firstIndex / 3, (d.firstIndex + d.indexCount) / 3, count);
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
