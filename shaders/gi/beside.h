// Which points of different voxels lie on the same side of the surface (gi/seen_in_voxel.h says it of one voxel).
#ifndef IRAD_BESIDE_H
#define IRAD_BESIDE_H
#include "gi/seen_in_voxel.h"
#include "gi/surface_point.h"
IRAD_BEGIN

IRAD_FN VoxelPieces piecesOf(SurfaceArrays surface, uint entry) {
  uint first = firstFacet(entry);
  return voxelPieces(surface.corners, surface.pieces, surface.boxes, vec3(unpackVoxel(surface.voxel.at[first])),
                     surface.firstPiece.at[first], surface.firstPiece.at[first + facetsOf(entry)]);
}

IRAD_FN uint entryOf(UintArray reverse, uvec3 dims, ivec3 v) {
  if (any(lessThan(v, ivec3(0))) || any(greaterThanEqual(v, ivec3(dims)))) return NO_FACET;
  return reverse.at[voxelIndex(uvec3(v), dims)];
}

/// Whether the segment crosses no triangle but two, in any of the voxels that it may pass.
IRAD_FN bool clearBetween(SurfaceArrays surface, UintArray reverse, uvec3 dims, vec3 a, vec3 b, uint except1, uint except2) {
  ivec3 lo = ivec3(floor(min(a, b))), hi = ivec3(floor(max(a, b)));
  for (int z = lo.z; z <= hi.z; ++z)
    for (int y = lo.y; y <= hi.y; ++y)
      for (int x = lo.x; x <= hi.x; ++x) {
        uint entry = entryOf(reverse, dims, ivec3(x, y, z));
        if (entry != NO_FACET && !clearInVoxel(piecesOf(surface, entry), a, b, except1, except2)) return false;
      }
  return true;
}

/// How far above a surfel ways from it begin, in the voxel that holds it.
IRAD_FN float liftOf(SurfaceArrays surface, UintArray reverse, uvec3 dims, SurfelPoint p) {
  uint entry = entryOf(reverse, dims, ivec3(floor(p.position)));
  return entry == NO_FACET ? ABOVE_SURFACE : clearAbove(piecesOf(surface, entry), p.position, p.facing, p.triangle);
}

IRAD_FN bool continues(SurfaceArrays surface, UintArray reverse, uvec3 dims, SidePoint from, SidePoint to) {
  SurfelPoint a = from.at, b = to.at;
  vec3 low = floor(min(a.position, b.position)), high = floor(max(a.position, b.position)) + 1.0f;
  SideWay way = wayBetween(surface.corners, low - AROUND_CELL, high + AROUND_CELL, a, b);
  if (!way.open) return false;
  SidePath path = pathOf(way, from, to);
  for (uint i = 0u; i < segmentsOf(path); ++i) {
    vec3 p, q;
    segmentAt(path, i, p, q);
    if (!clearBetween(surface, reverse, dims, p, q, way.pass1, way.pass2)) return false;
  }
  return true;
}

/// The surfel of a facet that is nearest to a point.
IRAD_FN SurfelPoint nearestSurfel(SurfaceArrays surface, uint facet, vec3 point, IRAD_INOUT(float) distance2) {
  FacetSurfels surfels = surfelsOf(surface, facet);
  distance2 = 1e30f;
  uint nearest = 0u;
  for (uint k = 0u; k < FACET_SURFELS; ++k) {
    vec3 d = surfelOf(surface, surfels, k).position - point;
    if (dot(d, d) >= distance2) continue;
    distance2 = dot(d, d);
    nearest = k;
  }
  return surfelOf(surface, surfels, nearest);
}

IRAD_END
#endif
