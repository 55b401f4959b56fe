// Points of the emitters (shared/emitters.h), and whether they are seen.
#ifndef IRAD_EMITTER_POINT_GLSL
#define IRAD_EMITTER_POINT_GLSL
#include "gi/trace.glsl"
#include "shared/emitters.h"

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

/// Whether a ray from a lifted point meets nothing before `reach`, where a point of an emitter is. A ten-thousandth of
/// it is more than the roundings of that point.
bool reaches(TraceWorld world, SurfaceArrays surface, SurfelPoint from, vec3 direction, float reach) {
  TraceHit hit = traceTriangles(world, surface, from.position, direction, from.triangle);
  return hit.facet == TRACE_ESCAPED || hit.t >= reach * (1.0 - 1e-4);
}

#endif
