// Points of the true surface in voxel units (docs/method.md 4).
#ifndef IRAD_SURFACE_POINT_GLSL
#define IRAD_SURFACE_POINT_GLSL
#include "shared/surface.h"

struct SurfelPoint {
  vec3 position, facing;  ///< voxel units
  uint triangle;
};

SurfelPoint surfelOf(SurfaceArrays surface, Surfel s) {
  uint triangle = s.triangle & ~SURFEL_BACK;
  vec3 a = surface.corners.at[3u * triangle];
  vec3 b = surface.corners.at[3u * triangle + 1u] - a;
  vec3 c = surface.corners.at[3u * triangle + 2u] - a;
  vec2 weights = unpackPlace(s.place);
  vec3 facing = normalize(cross(b, c));
  if ((s.triangle & SURFEL_BACK) != 0u) facing = -facing;
  return SurfelPoint(a + b * weights.x + c * weights.y, facing, triangle);
}

/// The unit normal of a triangle's side (as Surfel::triangle).
vec3 triangleFacing(SurfaceArrays surface, uint side) {
  uint triangle = side & ~SURFEL_BACK;
  vec3 a = surface.corners.at[3u * triangle];
  vec3 n = normalize(cross(surface.corners.at[3u * triangle + 1u] - a, surface.corners.at[3u * triangle + 2u] - a));
  return (side & SURFEL_BACK) != 0u ? -n : n;
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
  return (surface.links.at[FACET_LINKS * facet + i / 4u] >> (8u * (i % 4u))) & 255u;
}

#endif
