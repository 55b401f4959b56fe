// Points of the true surface in voxel units (docs/method.md 4).
#ifndef IRAD_SURFACE_POINT_GLSL
#define IRAD_SURFACE_POINT_GLSL
#include "gi/triangle_hit.glsl"
#include "shared/surface.h"

SurfelPoint surfelOf(SurfaceArrays surface, uint facet, uint k) {
  Surfel s = surface.surfels.at[FACET_SURFELS * facet + k];
  return surfelOn(triangleAt(surface.corners, s.triangle & ~SURFEL_BACK), s, unpackVoxel(surface.voxel.at[facet]));
}

/// The unit normal of a triangle's side (as Surfel::triangle).
vec3 triangleFacing(SurfaceArrays surface, uint side) {
  return facingOf(triangleAt(surface.corners, side & ~SURFEL_BACK), (side & SURFEL_BACK) != 0u);
}

/// The link of a facet to the voxel `i` of the 27 around, or NO_LINK.
uint facetLink(SurfaceArrays surface, uint facet, uint i) {
  return uint(surface.links.at[FACET_LINKS * facet + i]);
}

#endif
