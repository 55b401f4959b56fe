// Which points of different voxels lie on the same side of the surface (gi/seen_in_voxel.glsl says it of one voxel).
#ifndef IRAD_BESIDE_GLSL
#define IRAD_BESIDE_GLSL
#include "gi/seen_in_voxel.glsl"
#include "gi/surface_point.glsl"

VoxelPieces piecesOf(SurfaceArrays surface, uint entry) {
  uint first = firstFacet(entry);
  return voxelPieces(surface.corners, surface.pieces, surface.boxes, vec3(unpackVoxel(surface.voxel.at[first])),
                     surface.firstPiece.at[first], surface.firstPiece.at[first + facetsOf(entry)]);
}

uint entryOf(UintArray reverse, uvec3 dims, ivec3 v) {
  if (any(lessThan(v, ivec3(0))) || any(greaterThanEqual(v, ivec3(dims)))) return NO_FACET;
  return reverse.at[voxelIndex(uvec3(v), dims)];
}

/// Whether the segment crosses no triangle but two, in any of the voxels that it may pass.
bool clearBetween(SurfaceArrays surface, UintArray reverse, uvec3 dims, vec3 a, vec3 b, uint except1, uint except2) {
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
float liftOf(SurfaceArrays surface, UintArray reverse, uvec3 dims, SurfelPoint p) {
  uint entry = entryOf(reverse, dims, ivec3(floor(p.position)));
  return entry == NO_FACET ? ABOVE_SURFACE : clearAbove(piecesOf(surface, entry), p.position, p.facing, p.triangle);
}

bool continues(SurfaceArrays surface, UintArray reverse, uvec3 dims, SurfelPoint a, SurfelPoint b) {
  vec3 low = floor(min(a.position, b.position)), high = floor(max(a.position, b.position)) + 1.0;
  SideWay way = wayBetween(surface.corners, low - AROUND_CELL, high + AROUND_CELL, a, b);
  if (!way.open) return false;
  SidePath path = pathOf(way, SidePoint(a, liftOf(surface, reverse, dims, a)),
                         SidePoint(b, liftOf(surface, reverse, dims, b)));
  for (uint i = 0u; i < segmentsOf(path); ++i) {
    vec3 p, q;
    segmentAt(path, i, p, q);
    if (!clearBetween(surface, reverse, dims, p, q, way.pass1, way.pass2)) return false;
  }
  return true;
}

/// The surfel of a facet that is nearest to a point.
SurfelPoint nearestSurfel(SurfaceArrays surface, uint facet, vec3 point, out float distance2) {
  distance2 = 1e30;
  uint nearest = 0u;
  for (uint k = 0u; k < FACET_SURFELS; ++k) {
    vec3 d = surfelOf(surface, facet, k).position - point;
    if (dot(d, d) >= distance2) continue;
    distance2 = dot(d, d);
    nearest = k;
  }
  return surfelOf(surface, facet, nearest);
}

/// The facet of a voxel whose nearest surfel is nearest to a point of the surface, on its side, and nearer than `nearest`;
/// or NO_FACET. They are asked the nearest first: looking for that is little beside `continues`.
uint facetBesideIn(SurfaceArrays surface, UintArray reverse, uvec3 dims, ivec3 voxel, SurfelPoint p,
                   inout float nearest) {
  uint entry = entryOf(reverse, dims, voxel);
  if (entry == NO_FACET) return NO_FACET;
  float asked = -1.0;  // the distance of the last that was asked
  uint last = 0u;      // and which it was, from 1
  for (uint tries = 0u; tries < facetsOf(entry); ++tries) {
    float best = nearest;
    uint next = NO_FACET;
    SurfelPoint to;
    for (uint k = 0u; k < facetsOf(entry); ++k) {
      float distance2;
      SurfelPoint s = nearestSurfel(surface, firstFacet(entry) + k, p.position, distance2);
      if (distance2 >= best || distance2 < asked || (distance2 == asked && k < last) || !mayContinue(p, s)) continue;
      best = distance2;
      next = k;
      to = s;
    }
    if (next == NO_FACET) return NO_FACET;
    if (continues(surface, reverse, dims, p, to)) {
      nearest = best;
      return firstFacet(entry) + next;
    }
    asked = best;
    last = next + 1u;
  }
  return NO_FACET;
}

/// Of a voxel with more pieces than are looked at to tell sides apart, the facet that is near and faces the point's way;
/// NO_FACET of others.
uint facetInCrowd(SurfaceArrays surface, UintArray reverse, uvec3 dims, ivec3 voxel, SurfelPoint p) {
  uint found = NO_FACET, entry = entryOf(reverse, dims, voxel);
  if (entry == NO_FACET) return NO_FACET;
  VoxelPieces pieces = piecesOf(surface, entry);
  float best = 1e30;
  for (uint k = 0u; pieces.endLarge < pieces.end && k < facetsOf(entry); ++k) {
    uint facet = firstFacet(entry) + k;
    float distance2;
    SurfelPoint s = nearestSurfel(surface, facet, p.position, distance2);
    float apart = distance2 + 1.0 - dot(s.facing, p.facing);
    if (apart >= best) continue;
    best = apart;
    found = facet;
  }
  return found;
}

/// The same in the voxel that holds the point, then in the 27 around; where no surfel is seen in a crowd, a likely one.
uint facetBeside(SurfaceArrays surface, UintArray reverse, uvec3 dims, SurfelPoint p) {
  float nearest = 1e30;
  ivec3 voxel = ivec3(floor(p.position));
  uint found = facetBesideIn(surface, reverse, dims, voxel, p, nearest);
  if (found != NO_FACET) return found;
  for (int i = 0; i < 27; ++i) {
    uint other = facetBesideIn(surface, reverse, dims, voxel + ivec3(i % 3, (i / 3) % 3, i / 9) - 1, p, nearest);
    if (other != NO_FACET) found = other;
  }
  return found != NO_FACET ? found : facetInCrowd(surface, reverse, dims, voxel, p);
}

#endif
