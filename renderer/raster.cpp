#include "renderer/raster.h"

#include <algorithm>

#include "renderer/targets.h"
#include "shaders/shared/raster.h"

namespace irad {

static_assert(sizeof(RasterPiece) == RASTER_PIECE_BYTES);

uint32_t rasterQueuePieces(uint32_t triangles) {
  return triangles + triangles / 2 + 1024;  // clipping may turn a triangle into several
}
uint64_t rasterQueueBytes(uint32_t triangles) {
  return RASTER_COUNTS_BYTES + 2 * rasterPartBytes(rasterQueuePieces(triangles));
}
Buffer makeRasterQueue(const Device& device, SubsystemName subsystem, uint32_t triangles) {
  return Buffer(device, "large triangles", subsystem, rasterQueueBytes(triangles));
}

void rasterize(Frame& frame, const char* stage, std::string_view shader, const Buffer& queue, bool anyMasked,
               const std::function<void(Pass&, RasterStep, uint64_t queued)>& declare,
               const std::function<void(Commands&, RasterStep)>& body) {
  frame.pass(stage).update(queue, std::array<uint32_t, RASTER_COUNTS_BYTES / 4>{});
  for (const bool tiles : {false, true})
    for (const bool masked : {false, true}) {
      if (masked && !anyMasked) continue;
      const RasterStep step{tiles, masked};
      Pass pass = frame.pass(stage);
      pass.shader(shader).constant(RASTER_TILES, tiles);
      declare(pass, step, tiles ? pass.in(queue) : pass.accumulate(queue));
      pass.run([&](Commands& commands) { body(commands, step); });
    }
}

void rasterDispatch(Commands& commands, RasterStep step, uint32_t triangles, uint32_t dispatches) {
  if (step.tiles)
    commands.dispatchWorkgroups(std::max(RASTER_GROUPS / dispatches, 64u));
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
  push.size = raster.size;
  push.pieces = rasterQueuePieces(triangles);
  push.cull = raster.cull;
  push.channel = raster.channel;
  const auto drawn = [&](const Draw& draw) {
    return masked(draw) && (raster.blended || (scene.materialValues.at(draw.material).flags & MATERIAL_BLEND) == 0);
  };
  const auto dispatches = static_cast<uint32_t>(std::ranges::count_if(scene.scene.draws, drawn));
  const auto declare = [&](Pass& pass, RasterStep step, uint64_t queued) {
    pass.constant(RASTER_MASKED, step.masked);
    push.scene = pass.in(scene.record);
    push.projection = pass.in(raster.projections, raster.offset);
    push.queue = queued;
    push.peels = raster.peeled != nullptr;
    if (raster.peeled != nullptr) push.peeled = pass.in(*raster.peeled);
    push.target = pass.accumulate(raster.target, raster.targetOffset);
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
                if (drawn(d)) draw(d.material, d.firstIndex / 3, (d.firstIndex + d.indexCount) / 3, dispatches);
            });
}

void rasterVisible(Frame& frame, const SceneOnDevice& scene, const Buffer& camera, bool alphaTest, Targets& targets,
                   Layer layer) {
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
               .alphaTest = alphaTest,
               .blended = layer != Layer::opaque,
               .peeled = layer == Layer::behind ? &targets.peeledVisible : nullptr});
  Pass store = frame.pass(kStage);
  store.shader("raster/store_depth.comp").write(targets.depth).push(store.in(targets.visible)).dispatch(targets.size);
}

}  // namespace irad
