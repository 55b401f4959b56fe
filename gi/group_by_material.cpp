#include "gi/group_by_material.h"

#include <algorithm>

#include "renderer/gpu_scene.h"
#include "shaders/shared/surface.h"

namespace irad {

Order groupByMaterial(const SceneOnDevice& scene, const std::vector<uint32_t>& triangles, uint32_t textures) {
  Order order;
  order.groups.push_back({0, false});
  std::vector<uint32_t> groupOf(scene.scene.triangleCount(), 0);
  for (const Draw& draw : scene.scene.draws) {
    if ((scene.materialValues.at(draw.material).flags & textures) == 0) continue;
    std::fill_n(groupOf.begin() + draw.firstIndex / 3, draw.indexCount / 3, static_cast<uint32_t>(order.groups.size()));
    order.groups.push_back({draw.material, true});
  }
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
