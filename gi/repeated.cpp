#include "gi/repeated.h"

#include <algorithm>
#include <array>
#include <bit>
#include <unordered_map>

#include "renderer/scene/scene.h"
#include "shaders/shared/scene_gpu.h"

namespace irad {
namespace {

using Corner = std::array<uint32_t, 3>;
using Place = std::array<Corner, 3>;

/// The bits of the corners, the least first: the same from whichever corner a triangle starts.
Place placeOf(const Geometry& geometry, uint32_t triangle) {
  Place place;
  for (uint32_t i = 0; i < 3; ++i) {
    const glm::vec3& p = geometry.positions[geometry.indices[3 * size_t{triangle} + i]];
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

std::vector<SamePlace> samePlaces(const Geometry& geometry) {
  const uint32_t count = geometry.triangleCount();
  std::vector<SamePlace> same;
  // Open addressing. Upper bits of hashes, lest corners are read of places that only share a slot.
  struct Slot {
    uint32_t hash = 0;
    uint32_t first = 0;  ///< from 1
  };
  std::vector<Slot> table(std::bit_ceil(2 * size_t{count} + 1));
  for (uint32_t t = 0; t < count; ++t) {
    const Place place = placeOf(geometry, t);
    const uint64_t hash = hashOf(place);
    const auto upper = static_cast<uint32_t>(hash >> 32);
    size_t slot = hash & (table.size() - 1);
    while (table[slot].first != 0 && (table[slot].hash != upper || placeOf(geometry, table[slot].first - 1) != place))
      slot = (slot + 1) & (table.size() - 1);
    if (table[slot].first == 0)
      table[slot] = {upper, t + 1};
    else
      same.push_back({table[slot].first - 1, t});
  }
  return same;
}

std::vector<uint32_t> repeatedTriangles(std::span<const SamePlace> same, std::span<const uint32_t> flags) {
  std::vector<uint32_t> repeated;
  std::unordered_map<uint32_t, uint32_t> standing;  // in each place, by the first there: what may stand for others
  for (const auto& [first, t] : same) {
    uint32_t& one = standing.try_emplace(first, first).first->second;
    const bool stands = (flags[one] & MATERIAL_ALPHA_MASK) == 0 &&
                        ((flags[one] & MATERIAL_DOUBLE_SIDED) != 0 || (flags[t] & MATERIAL_DOUBLE_SIDED) == 0);
    if (!stands) {
      one = t;
      continue;
    }
    repeated.resize(flags.size(), 0);
    repeated[t] = one + 1;
  }
  return repeated;
}

}  // namespace irad
