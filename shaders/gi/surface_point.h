// Points of the true surface in voxel units (docs/method.md 4).
#ifndef IRAD_SURFACE_POINT_H
#define IRAD_SURFACE_POINT_H
#include "gi/triangle_hit.h"
#include "shared/surface.h"
IRAD_BEGIN

/// What is kept of all surfels of a facet together.
struct FacetSurfels {
  uint places;  ///< in SurfaceArrays::surfels
  uvec2 sides;
  uint firstPiece;
  uvec3 voxel;
};
IRAD_FN FacetSurfels surfelsOf(SurfaceArrays surface, uint facet) {
  uint at = SURFEL_WORDS * facet, sides = at + FACET_SURFELS;
  FacetSurfels surfels = {at, uvec2(surface.surfels.at[sides], surface.surfels.at[sides + 1u]),
                          surface.firstPiece.at[facet], unpackVoxel(surface.voxel.at[facet])};
  return surfels;
}

IRAD_FN Surfel surfelAt(SurfaceArrays surface, FacetSurfels facet, uint k) {
  uint side = ((k < 4u ? facet.sides.x : facet.sides.y) >> (8u * (k % 4u))) & 0xFFu;
  if (facet.sides.y == WIDE_SIDES)
    side = (surface.wideSides.at[WIDE_WORDS * facet.sides.x + k / 2u] >> (16u * (k % 2u))) & 0xFFFFu;
  uint triangle = triangleOf(surface.pieces, facet.firstPiece + side / 2u);
  Surfel surfel = {triangle | ((side & 1u) != 0u ? SURFEL_BACK : 0u), surface.surfels.at[facet.places + k]};
  return surfel;
}

IRAD_FN SurfelPoint surfelOf(SurfaceArrays surface, FacetSurfels facet, uint k) {
  Surfel s = surfelAt(surface, facet, k);
  return surfelOn(triangleAt(surface.corners, s.triangle & ~SURFEL_BACK), s, facet.voxel);
}
IRAD_FN SurfelPoint surfelOf(SurfaceArrays surface, uint facet, uint k) {
  return surfelOf(surface, surfelsOf(surface, facet), k);
}

/// The unit normal of a triangle's side (as Surfel::triangle).
IRAD_FN vec3 triangleFacing(SurfaceArrays surface, uint side) {
  return facingOf(triangleAt(surface.corners, side & ~SURFEL_BACK), (side & SURFEL_BACK) != 0u);
}

/// What is kept of all links of a facet together.
struct FacetLinks {
  uint facet, mask, first;
  ivec3 voxel;
};
IRAD_FN FacetLinks linksOf(SurfaceArrays surface, uint facet, uint voxel) {
  FacetLinks links = {facet, surface.linkMasks.at[facet], surface.firstLinks.at[facet], ivec3(unpackVoxel(voxel))};
  return links;
}

/// From a voxel to that at place `i` of the 27 around it.
IRAD_FN ivec3 stepTo(uint i) { return ivec3(int(i % 3u), int((i / 3u) % 3u), int(i / 9u)) - 1; }

/// The facet that continues the surface of one in the voxel `i` of the 27 around, or NO_FACET.
IRAD_FN uint linkedFacet(SurfaceArrays surface, UintArray reverse, uvec3 dims, FacetLinks from, uint i) {
  if (i == OWN_VOXEL) return from.facet;
  if ((from.mask >> i & 1u) == 0u) return NO_FACET;
  uint link = uint(surface.links.at[from.first + uint(bitCount(from.mask & ((1u << i) - 1u)))]);
  ivec3 beside = from.voxel + stepTo(i);
  return firstFacet(reverse.at[voxelIndex(uvec3(beside), dims)]) + link;
}

IRAD_END
#endif
