// The facets that emit, as a table to draw from.
#pragma once

#include <vector>

#include "renderer/resources.h"
#include "shaders/shared/emitters.h"

namespace irad {

class Context;
struct FacetList;

/// The facets that emit, to be drawn in proportion to their power. count 0: none, and no buffers.
struct Emitters {
  uint32_t count = 0;
  float brightest = 0;     ///< largest luminance(M), W/m^2
  float power = 0;         ///< EmitterTable
  Buffer entries, record;  ///< Emitter per facet, one EmitterTable
};
Emitters listEmitters(Context& context, const FacetList& facets);

/// Vose's alias table of facets[i] with probability powers[i] / sum; powers > 0.
std::vector<Emitter> makeAliasTable(const std::vector<uint32_t>& facets, const std::vector<double>& powers);

}  // namespace irad
