// The facet list (docs/method.md 2-4): structure of arrays, Morton order of voxels, the facets of a voxel next to each
// other. The reverse map leads from a voxel to its facets.
#ifndef IRAD_SHARED_FACETS_H
#define IRAD_SHARED_FACETS_H
#include "shared/types.h"
IRAD_BEGIN

IRAD_CONST uint NO_FACET = 0xFFFFFFFFu;
/// Reverse map entry: NO_FACET, or in bits 0-25 the index of the voxel's first facet, which the others follow, and in
/// bits 26-31 how many others.
IRAD_CONST uint MAX_FACETS = (1u << 26) - 1u;
IRAD_FN uint facetEntryOf(uint first, uint facets) {
  return first | ((facets - 1u) << 26);
}
IRAD_FN uint firstFacet(uint entry) {
  return entry & MAX_FACETS;
}
/// For an entry that is not NO_FACET.
IRAD_FN uint facetsOf(uint entry) {
  return (entry >> 26) + 1u;
}
/// Facet word `shape`: bits 0-15 normal code (encoding of voxel.normals), bits 16-23 signed plane offset: distance of
/// the surface from the voxel's centre along the normal, in 1/127 voxel, biased by 128.
IRAD_FN float facetOffset(uint shape) {
  return (float((shape >> 16) & 255u) - 128.0f) * (1.0f / 127.0f);
}
IRAD_FN uint packFacetOffset(float offset) {
  float clamped = offset < -1.0f ? -1.0f : (offset > 1.0f ? 1.0f : offset);
  return uint(int(floor(clamped * 127.0f + 0.5f)) + 128) << 16;
}

/// Albedo: three 16-bit unorms (x: r | g << 16, y: b), so that rho = .95 keeps B = 20 E within .02 %.
IRAD_FN uvec2 packAlbedo(vec3 a) {
  uvec3 q =
      uvec3(uint(floor(a.x * 65535.0f + 0.5f)), uint(floor(a.y * 65535.0f + 0.5f)), uint(floor(a.z * 65535.0f + 0.5f)));
  return uvec2(q.x | (q.y << 16), q.z);
}
IRAD_FN vec3 unpackAlbedo(uvec2 p) {
  return vec3(float(p.x & 0xFFFFu), float(p.x >> 16), float(p.y & 0xFFFFu)) * (1.0f / 65535.0f);
}

struct FacetArrays {
  UintArray voxel;     ///< packVoxel
  UintArray shape;     ///< normal code, offset, flags
  Uvec2Array albedo;   ///< packAlbedo, clamped to [0, .98]
  Vec3Array emission;  ///< exitance M = pi x emitted radiance, W/m^2
  UintArray reverse;   ///< one per voxel (linear index)
  uint count;
  uint hasEmission;  ///< 0: `emission` must not be read
};
IRAD_ARRAY(FacetRecord, FacetArrays, 16)

IRAD_END
#endif
