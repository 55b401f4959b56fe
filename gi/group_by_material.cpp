#include "gi/group_by_material.h"

#include <algorithm>

#include "renderer/gpu_scene.h"
#include "shaders/shared/surface.h"

namespace irad {

std::vector<uint32_t> ofTriangles(const Scene& scene, const std::function<uint32_t(const Draw&)>& valueOf) {
  std::vector<uint32_t> values(scene.triangleCount(), 0);
  for (const Draw& draw : scene.draws)
    std::fill_n(values.begin() + draw.firstIndex / 3, draw.indexCount / 3, valueOf(draw));
  return values;
}

std::vector<uint32_t> flagsOfTriangles(const SceneOnDevice& scene) {
  return ofTriangles(scene.scene, [&](const Draw& draw) { return scene.materialValues.at(draw.material).flags; });
}

Order groupByMaterial(const SceneOnDevice& scene, const std::vector<uint32_t>& triangles, uint32_t textures) {
  Order order;
  order.groups.push_back({0, 0});
  const std::vector<uint32_t> groupOf = ofTriangles(scene.scene, [&](const Draw& draw) -> uint32_t {
    const uint32_t flags = scene.materialValues.at(draw.material).flags & (textures | MATERIAL_ALPHA_MASK);
    if ((flags & textures) == 0) return 0;
    order.groups.push_back({draw.material, flags});
    return order.groups.size() - 1;
  });
  for (const uint32_t t : triangles) ++order.groups[groupOf[t & ~SURFEL_BACK]].count;
  std::vector<uint32_t> next;
  uint32_t first = 0;
  for (MaterialGroup& group : order.groups) {
    group.first = first;
    next.push_back(first);
    first += group.count;
  }
  order.items.resize(triangles.size());
  for (uint32_t i = 0; i < triangles.size(); ++i) order.items[next[groupOf[triangles[i] & ~SURFEL_BACK]]++] = i;
  return order;
}

}  // namespace irad
