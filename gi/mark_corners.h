// What rays must know of a facet's surroundings (docs/method.md 4).
#pragma once

#include <cstdint>

namespace irad {

class Context;
struct FacetList;

/// Sets FACET_CORNER, the clear distance and the joints in the list's shape words, and fills `around`; the last step of
/// the two functions that make lists. `slots`: facets of a voxel that were looked for.
void markCorners(Context& context, FacetList& list, uint32_t slots);

}  // namespace irad
