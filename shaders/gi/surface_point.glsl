// Points of the true surface in voxel units (docs/method.md 4).
#ifndef IRAD_SURFACE_POINT_GLSL
#define IRAD_SURFACE_POINT_GLSL
#include "gi/triangle_hit.glsl"
#include "shared/surface.h"

struct SurfelPoint {
  vec3 position, facing;  ///< voxel units
  uint triangle;
};

SurfelPoint surfelOf(SurfaceArrays surface, Surfel s) {
  uint triangle = s.triangle & ~SURFEL_BACK;
  Triangle t = triangleAt(surface.corners, triangle);
  vec2 weights = unpackPlace(s.place);
  return SurfelPoint(t.a + (t.b - t.a) * weights.x + (t.c - t.a) * weights.y,
                     facingOf(t, (s.triangle & SURFEL_BACK) != 0u), triangle);
}

/// The unit normal of a triangle's side (as Surfel::triangle).
vec3 triangleFacing(SurfaceArrays surface, uint side) {
  return facingOf(triangleAt(surface.corners, side & ~SURFEL_BACK), (side & SURFEL_BACK) != 0u);
}

SurfelPoint surfelOf(SurfaceArrays surface, uint facet, uint k) {
  return surfelOf(surface, surface.surfels.at[FACET_SURFELS * facet + k]);
}

/// How far a ray starts above its triangle, as a share of the coordinates: eight times what these round to.
const float START_LIFT = 8.0 / 16777216.0;

vec3 liftedStart(vec3 position, vec3 facing) {
  vec3 size = abs(position);
  return position + facing * (START_LIFT * max(1.0, max(size.x, max(size.y, size.z))));
}

/// The link of a facet to the voxel `i` of the 27 around, or NO_LINK.
uint facetLink(SurfaceArrays surface, uint facet, uint i) {
  return uint(surface.links.at[FACET_LINKS * facet + i]);
}

#endif
