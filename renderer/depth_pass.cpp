#include "renderer/depth_pass.h"

#include "shaders/shared/passes.h"

namespace irad {
namespace {

/// Triangles that one draw takes.
struct Range {
  uint32_t firstIndex, indexCount;
  VkCullModeFlags cull;
  uint32_t material;  ///< of masked ones
};

/// Opaque neighbours in the index buffer are one range where they are culled alike: depth does not depend on materials.
std::vector<Range> ranges(const SceneOnDevice& scene, const DepthPass& depth, bool masked) {
  std::vector<Range> ranges;
  for (const Draw& draw : depth.draws ? *depth.draws : scene.scene.draws) {
    const uint32_t flags = scene.materialValues.at(draw.material).flags;
    if ((depth.alphaTest && (flags & MATERIAL_ALPHA_MASK) != 0) != masked) continue;
    if (masked && !depth.blended && (flags & MATERIAL_BLEND) != 0) continue;
    const VkCullModeFlags mode =
        depth.cull && (flags & MATERIAL_DOUBLE_SIDED) == 0 ? VK_CULL_MODE_BACK_BIT : VK_CULL_MODE_NONE;
    if (!masked && !ranges.empty()) {
      Range& last = ranges.back();
      if (last.cull == mode && last.firstIndex + last.indexCount == draw.firstIndex) {
        last.indexCount += draw.indexCount;
        continue;
      }
    }
    ranges.push_back({draw.firstIndex, draw.indexCount, mode, draw.material});
  }
  return ranges;
}

}  // namespace

void drawDepth(Frame& frame, const SceneOnDevice& scene, const DepthPass& depth) {
  Pass opaque = frame.pass(depth.stage);
  DepthPush push{opaque.in(scene.record), opaque.in(depth.projections, depth.offset), 0, depth.screens};
  opaque.shaders({"forward/depth.vert", "forward/depth.frag"})
      .indices(scene.indices)
      .depth(depth.target, /*write*/ true, /*clear*/ 0.0f, depth.layer)
      .depthCompare(VK_COMPARE_OP_GREATER_OR_EQUAL)
      .run([&](Commands& commands) {
        commands.push(push);
        for (const Range& range : ranges(scene, depth, /*masked*/ false)) {
          commands.cull(range.cull);
          commands.drawIndexed(range.indexCount, range.firstIndex);
        }
      });
  if (!depth.alphaTest) return;
  Pass masked = frame.pass(depth.stage);
  push.scene = masked.in(scene.record);
  push.projection = masked.in(depth.projections, depth.offset);
  masked.shaders({"forward/depth_masked.vert",
                  depth.peeled != nullptr ? "forward/depth_peeled.frag" : "forward/depth_masked.frag"});
  if (depth.peeled != nullptr) masked.sample(*depth.peeled, pointSampler(frame.context().device));
  masked.indices(scene.indices)
      .depth(depth.target, /*write*/ true, {}, depth.layer)
      .depthCompare(VK_COMPARE_OP_GREATER_OR_EQUAL)
      .run([&](Commands& commands) {
        for (const Range& range : ranges(scene, depth, /*masked*/ true)) {
          push.material = range.material;
          commands.cull(range.cull);
          commands.bindMaterial(scene.materialSets.at(range.material));
          commands.push(push);
          commands.drawIndexed(range.indexCount, range.firstIndex);
        }
      });
}

}  // namespace irad
