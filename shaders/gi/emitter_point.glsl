// Emitters by chance (shared/emitters.h).
#ifndef IRAD_EMITTER_POINT_GLSL
#define IRAD_EMITTER_POINT_GLSL
#include "shared/emitters.h"
#include "shared/sampling.h"

/// An emissive facet drawn in proportion to power; `rest` is uniform in (0, 1) again.
uint emitterFacet(EmitterTable table, uint u, out float rest) {
  uint i, low;
  umulExtended(u, table.count, i, low);
  Emitter e = table.entries.at[i];
  float x = unitFloat(low);
  bool own = x < e.keep;
  rest = own ? x / e.keep : (x - e.keep) / (1.0 - e.keep);
  return own ? e.facet : e.other;
}

#endif
