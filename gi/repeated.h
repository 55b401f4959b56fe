// Triangles that lie where another one does and face its way, as files often hold some.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

namespace irad {

struct Geometry;

/// A triangle in the same place as an earlier one: the same three positions in the same turn.
struct SamePlace {
  uint32_t first, triangle;  ///< `first`: the earliest in that place
};
/// Ascending by triangle.
std::vector<SamePlace> samePlaces(const Geometry& geometry);

/// Of each triangle, counted from 1, the first in the same place, if that can stand for it: no mask cuts holes that
/// this one fills, and it shows its back where this one does. 0: none, as of all where the result is empty. `flags`:
/// MATERIAL_* of each triangle.
std::vector<uint32_t> repeatedTriangles(std::span<const SamePlace> same, std::span<const uint32_t> flags);

}  // namespace irad
