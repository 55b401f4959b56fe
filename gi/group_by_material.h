// What is shaded by material: each material's textures have to be bound by themselves.
#pragma once

#include <algorithm>
#include <cstdint>
#include <functional>
#include <set>
#include <vector>

#include "renderer/frame/frame.h"
#include "renderer/gpu_scene.h"
#include "shaders/shared/constants.h"
#include "shaders/shared/scene_gpu.h"

namespace irad {

/// A value of each triangle: that of its draw. They are asked in their order.
std::vector<uint32_t> ofTriangles(const Scene& scene, const std::function<uint32_t(const Draw&)>& valueOf);
/// MATERIAL_*.
std::vector<uint32_t> flagsOfTriangles(const SceneOnDevice& scene);

/// What one dispatch takes.
struct MaterialGroup {
  uint32_t material;              ///< whose set is bound
  uint32_t flags;                 ///< MATERIAL_* of its textures and mask; 0: samples no texture
  uint32_t first = 0, count = 0;  ///< within the order
};
struct Order {
  std::vector<MaterialGroup> groups;
  std::vector<uint32_t> items;  ///< indices, group after group
};
/// What albedo and emission are read from.
inline constexpr uint32_t kColorTextures = MATERIAL_BASE_COLOR_TEXTURE | MATERIAL_METALLIC_ROUGHNESS_TEXTURE |
                                           MATERIAL_EMISSIVE_TEXTURE | MATERIAL_TRANSMISSION_TEXTURE;
/// Groups items, given by their triangles (bit 31 is ignored), by material, those that sample none of `textures`
/// together: a counting sort on the host, since a dispatch over all items for each material would mostly idle.
Order groupByMaterial(const SceneOnDevice& scene, const std::vector<uint32_t>& triangles,
                      uint32_t textures = kColorTextures);

/// Records a shader over every item, group after group: those for which a pipeline has the same code in a
/// pass of their own. `push` makes a pass's push constants; of these `first` and `count` are filled in here.
template <class MakePush>
void dispatchByMaterial(Frame& frame, const char* stage, const char* shader, const SceneOnDevice& scene,
                        const Order& order, MakePush makePush) {
  const bool panes = std::ranges::any_of(scene.materialValues,
                                         [](const GpuMaterial& m) { return (m.flags & MATERIAL_TRANSMISSIVE) != 0; });
  const bool isCpu = frame.context().device.isCpu;
  // On GPUs one pipeline for all that sample any texture: what they look up for nothing is less than another pass.
  const auto codeOf = [&](const MaterialGroup& group) { return group.flags == 0 || isCpu ? group.flags : ~0u; };
  std::set<uint32_t> codes;
  for (const MaterialGroup& group : order.groups)
    if (group.count > 0) codes.insert(codeOf(group));
  for (const uint32_t code : codes) {
    Pass pass = frame.pass(stage);
    auto push = makePush(pass);
    pass.shader(shader)
        .constant(CONSTANT_SAMPLES_TEXTURES, code != 0)
        .constant(CONSTANT_MATERIAL_FLAGS, code)
        .constant(CONSTANT_TINTED, panes)
        .constant(CONSTANT_CLIPS_SHARED, isCpu)
        .run([&](Commands& commands) {
          for (const MaterialGroup& group : order.groups) {
            if (group.count == 0 || codeOf(group) != code) continue;
            commands.bindMaterial(scene.materialSets.at(group.material));
            push.first = group.first;
            push.count = group.count;
            commands.push(push);
            commands.dispatch(group.count);
          }
        });
  }
}

}  // namespace irad
