#include "gi/repeated.h"

#include <algorithm>
#include <array>
#include <bit>

#include "gi/group_by_material.h"
#include "renderer/gpu_scene.h"

namespace irad {
namespace {

using Corner = std::array<uint32_t, 3>;
using Place = std::array<Corner, 3>;

/// The bits of the corners, the least first: the same from whichever corner a triangle starts.
Place placeOf(const Scene& scene, uint32_t triangle) {
  Place place;
  for (uint32_t i = 0; i < 3; ++i) {
    const glm::vec3& p = scene.positions[scene.indices[3 * size_t{triangle} + i]];
    for (int axis = 0; axis < 3; ++axis)
      place[i][axis] = p[axis] == 0 ? 0 : std::bit_cast<uint32_t>(p[axis]);  // -0 is 0
  }
  std::rotate(place.begin(), std::ranges::min_element(place), place.end());  // Clang 14 cannot compile the ranges' own
  return place;
}

uint64_t hashOf(const Place& place) {
  uint64_t hash = 0;
  for (const Corner& corner : place)
    for (const uint32_t word : corner) {
      hash = (hash ^ word) * 0x9E3779B97F4A7C15u;
      hash ^= hash >> 29;
    }
  return hash;
}

}  // namespace

std::vector<uint32_t> repeatedTriangles(const SceneOnDevice& scene) {
  const uint32_t count = scene.scene.triangleCount();
  const std::vector<uint32_t> flags = flagsOfTriangles(scene);
  std::vector<uint32_t> repeated;
  // Open addressing. Upper bits of hashes, lest corners are read of places that only share a slot.
  struct Slot {
    uint32_t hash = 0;
    uint32_t first = 0;  ///< a triangle that may stand for others, from 1
  };
  std::vector<Slot> table(std::bit_ceil(2 * size_t{count} + 1));
  for (uint32_t t = 0; t < count; ++t) {
    const Place place = placeOf(scene.scene, t);
    const uint64_t hash = hashOf(place);
    const auto upper = static_cast<uint32_t>(hash >> 32);
    size_t slot = hash & (table.size() - 1);
    while (table[slot].first != 0 &&
           (table[slot].hash != upper || placeOf(scene.scene, table[slot].first - 1) != place))
      slot = (slot + 1) & (table.size() - 1);
    const uint32_t first = table[slot].first;
    const bool stands = first != 0 && (flags[first - 1] & MATERIAL_ALPHA_MASK) == 0 &&
                        ((flags[first - 1] & MATERIAL_DOUBLE_SIDED) != 0 || (flags[t] & MATERIAL_DOUBLE_SIDED) == 0);
    if (!stands) {
      table[slot] = {upper, t + 1};
      continue;
    }
    repeated.resize(count, 0);
    repeated[t] = first;
  }
  return repeated;
}

}  // namespace irad
