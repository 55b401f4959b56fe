// What is shaded by material: each material's textures have to be bound by themselves.
#pragma once

#include <cstdint>
#include <vector>

namespace irad {

class SceneOnDevice;

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
/// Groups items, given by their triangles (bit 31 is ignored), by material, those that sample no texture together: a
/// counting sort on the host, since a dispatch over all items for each material would mostly idle.
Order groupByMaterial(const SceneOnDevice& scene, const std::vector<uint32_t>& triangles);

}  // namespace irad
