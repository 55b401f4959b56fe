// Emitters by chance (shared/emitters.h).
#ifndef IRAD_EMITTER_POINT_GLSL
#define IRAD_EMITTER_POINT_GLSL
#include "shared/emitters.h"

/// An emissive facet drawn in proportion to power; `rest` is uniform in (0, 1) again.
uint emitterFacet(EmitterTable table, uint u, out float rest) {
  uint i, low;
  umulExtended(u, table.count, i, low);
  rest = unitFloat(low);
  return drawnFacet(table.entries.at[i], rest);
}

#endif
