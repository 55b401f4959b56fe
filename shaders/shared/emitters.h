// The emissive facets as a table from which one is drawn in proportion to its power (Walker's alias method, 1977), so
// that specular rays and the samples of the first gather can be sent to them.
#ifndef IRAD_SHARED_EMITTERS_H
#define IRAD_SHARED_EMITTERS_H
#include "shared/sampling.h"
#include "shared/types.h"
IRAD_BEGIN

IRAD_FN float luminance(vec3 c) {
  return 0.2126f * c.x + 0.7152f * c.y + 0.0722f * c.z;
}

/// An entry is drawn with equal chance; it stands for `facet` with probability `keep`, else for `other`.
struct Emitter {
  uint facet, other;
  float keep;
};
IRAD_ARRAY(EmitterArray, Emitter, 4)

/// The facet that an entry stands for, by x in (0, 1), which becomes uniform there again.
IRAD_FN uint drawnFacet(Emitter e, IRAD_INOUT(float) x) {
  bool own = x < e.keep;
  x = own ? x / e.keep : (x - e.keep) / (1.0f - e.keep);
  return own ? e.facet : e.other;
}

struct EmitterTable {
  EmitterArray entries;
  uint count;
  float power;  ///< sum of luminance(M) x area over the facets, W/m^2 x voxels^2
};
IRAD_ARRAY(EmitterRecord, EmitterTable, 8)

IRAD_END
#endif
