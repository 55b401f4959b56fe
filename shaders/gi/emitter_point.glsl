// A point of the emitters (shared/emitters.h).
#ifndef IRAD_EMITTER_POINT_GLSL
#define IRAD_EMITTER_POINT_GLSL
#include "shared/emitters.h"
#include "shared/facets.h"
#include "shared/grid.h"
#include "shared/normals.h"
#include "shared/trace.h"

/// Point `u` of an emissive facet drawn in proportion to power, voxels, and the facet's normal; false where it lies
/// outside the facet's cell.
bool emitterPoint(EmitterTable table, FacetArrays facets, uint encoding, uvec2 u, out uint facet, out vec3 point,
                  out vec3 normal) {
  uint i, rest;
  umulExtended(u.x, table.count, i, rest);
  Emitter e = table.entries.at[i];
  float x = unitFloat(rest);
  bool own = x < e.keep;
  facet = own ? e.facet : e.other;
  x = own ? x / e.keep : (x - e.keep) / (1.0 - e.keep);
  uint shape = facets.shape.at[facet];
  normal = decodeNormal(shape & 0xFFFFu, encoding);
  uvec3 voxel = unpackVoxel(facets.voxel.at[facet]);
  point = facetPoint(voxel, normal, facetOffset(shape), vec2(x, unitFloat(u.y)));
  return all(lessThanEqual(abs(point - vec3(voxel) - 0.5), vec3(0.5)));
}

#endif
