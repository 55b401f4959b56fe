// A point of the emitters (shared/emitters.h).
#ifndef IRAD_EMITTER_POINT_GLSL
#define IRAD_EMITTER_POINT_GLSL
#include "shared/emitters.h"
#include "shared/facets.h"
#include "shared/grid.h"
#include "shared/normals.h"
#include "shared/trace.h"

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

/// Point `u` of an emissive facet drawn in proportion to power, voxels, and the facet's normal; false where it lies
/// outside the facet's cell.
bool emitterPoint(EmitterTable table, FacetArrays facets, uint encoding, uvec2 u, out uint facet, out vec3 point,
                  out vec3 normal) {
  float x;
  facet = emitterFacet(table, u.x, x);
  uint shape = facets.shape.at[facet];
  normal = decodeNormal(shape & 0xFFFFu, encoding);
  uvec3 voxel = unpackVoxel(facets.voxel.at[facet]);
  point = facetPoint(voxel, normal, facetOffset(shape), vec2(x, unitFloat(u.y)));
  return all(lessThanEqual(abs(point - vec3(voxel) - 0.5), vec3(0.5)));
}

#endif
