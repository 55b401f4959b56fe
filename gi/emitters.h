// The facets that emit, as a table to draw from.
#pragma once

#include <glm/glm.hpp>
#include <span>
#include <vector>

#include "renderer/resources.h"
#include "shaders/shared/emitters.h"

namespace irad {

class Context;
struct FacetList;

/// What emits, to be drawn in proportion to its power. count 0: nothing, and no buffers.
struct Emitters {
  uint32_t count = 0;
  float brightest = 0;     ///< largest luminance(M), W/m^2
  float power = 0;         ///< EmitterTable::power
  Buffer entries, record;  ///< Emitter each, one EmitterTable
};
/// The facets that emit.
Emitters listEmitters(Context& context, const FacetList& facets);
/// Of things with an exitance M, W/m^2, and an area, voxels^2, those that emit.
Emitters listEmitters(Context& context, std::span<const uint32_t> things, std::span<const glm::vec3> exitances,
                      std::span<const float> areas);

/// Vose's alias table of facets[i] with probability powers[i] / sum; powers > 0.
std::vector<Emitter> makeAliasTable(const std::vector<uint32_t>& facets, const std::vector<double>& powers);

}  // namespace irad
