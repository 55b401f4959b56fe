// What is shaded by material: each material's textures have to be bound by themselves.
#pragma once

#include <algorithm>
#include <cstdint>
#include <functional>
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
  uint32_t material;  ///< whose set is bound
  bool textured;
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

/// Records a shader over every item, group after group: those that sample no texture in a pass of their own. `push`
/// makes a pass's push constants; of these `first` and `count` are filled in here.
template <class MakePush>
void dispatchByMaterial(Frame& frame, const char* stage, const char* shader, const SceneOnDevice& scene,
                        const Order& order, MakePush makePush) {
  const bool panes = std::ranges::any_of(scene.materialValues,
                                         [](const GpuMaterial& m) { return (m.flags & MATERIAL_TRANSMISSIVE) != 0; });
  for (const bool textured : {false, true}) {
    const auto takes = [=](const MaterialGroup& g) { return g.textured == textured && g.count > 0; };
    if (std::ranges::none_of(order.groups, takes)) continue;
    Pass pass = frame.pass(stage);
    auto push = makePush(pass);
    pass.shader(shader)
        .constant(CONSTANT_SAMPLES_TEXTURES, textured)
        .constant(CONSTANT_TINTED, panes)
        .constant(CONSTANT_CLIPS_SHARED, frame.context().device.isCpu)
        .run([&](Commands& commands) {
          for (const MaterialGroup& group : order.groups) {
            if (!takes(group)) continue;
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
