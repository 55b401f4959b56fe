// The facet of a point of the surface where its piece does not tell it (docs/method.md 7): as of one pixel in thirty
// thousand of simple scenes, and of many where much is in a voxel. Some invocations share the search for a pixel: one alone
// would take longer than all others together for the rest of the picture.
#ifndef IRAD_SOUGHT_FACET_GLSL
#define IRAD_SOUGHT_FACET_GLSL
#include "gi/surface_lookup.glsl"
#include "shared/constants.h"
#include "shared/picked.h"

layout(constant_id = CONSTANT_SOUGHT_LANES) const uint SOUGHT_LANES = 32u;  ///< of 1, 32

/// The facet of a voxel whose nearest surfel is nearest to a point of the surface, on its side, and nearer than `nearest`;
/// or NO_FACET. They are asked the nearest first: looking for that is little beside `continues`.
uint facetBesideIn(SurfaceArrays surface, UintArray reverse, uvec3 dims, ivec3 voxel, SidePoint from,
                   inout float nearest) {
  SurfelPoint p = from.at;
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
    if (continues(surface, reverse, dims, from, to)) {
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

/// Which of those that share a pixel's search an invocation is, and the pixel's place on the list.
uint soughtLane() { return gl_LocalInvocationIndex % SOUGHT_LANES; }
uint soughtPlace() {
  return (gl_WorkGroupID.x * SOUGHT_LANES + gl_WorkGroupID.y) * (PICKED_GROUP / SOUGHT_LANES) +
         gl_LocalInvocationIndex / SOUGHT_LANES;
}

/// A facet that may be the one, and what the least of decides among them.
struct Candidate {
  uint facet;
  float rank;
};
const Candidate NO_CANDIDATE = Candidate(NO_FACET, 1e30);

shared Candidate soughtBy[gl_WorkGroupSize.x];

/// The best of what the lanes of a pixel have found. All invocations of the workgroup call it.
Candidate bestOf(Candidate mine) {
  if (SOUGHT_LANES == 1u) return mine;
  uint at = gl_LocalInvocationIndex, first = at - soughtLane();
  soughtBy[at] = mine;
  barrier();
  Candidate best = NO_CANDIDATE;
  for (uint i = first; i < first + SOUGHT_LANES; ++i)
    if (soughtBy[i].rank < best.rank) best = soughtBy[i];
  barrier();
  return best;
}

/// A lane's candidate where rounding has put a point of a triangle's side into another voxel: the first of the next ones
/// in which the triangle has a piece there.
Candidate foundByRounding(SurfaceArrays surface, UintArray reverse, uvec3 dims, vec3 p, uint side) {
  const float ROUNDING = 1e-2;
  ivec3 cell = ivec3(floor(p));
  vec3 inside = p - vec3(cell);
  ivec3 beside = ivec3(greaterThan(inside, vec3(1.0 - ROUNDING))) - ivec3(lessThan(inside, vec3(ROUNDING)));
  for (uint i = soughtLane(); i < 8u; i += SOUGHT_LANES) {
    ivec3 corner = ivec3(i & 1u, (i >> 1) & 1u, i >> 2);
    if (corner * abs(beside) != corner) continue;
    uint entry = entryOf(reverse, dims, cell + corner * beside);
    uint facet = entry == NO_FACET ? NO_FACET : facetInVoxel(surface, entry, p, side);
    if (facet != NO_FACET) return Candidate(facet, float(i));
  }
  return NO_CANDIDATE;
}

/// A lane's candidate by its distance, of those whose nearest surfel is seen from the point.
Candidate foundAround(SurfaceArrays surface, UintArray reverse, uvec3 dims, SidePoint from) {
  Candidate found = NO_CANDIDATE;
  ivec3 cell = ivec3(floor(from.at.position));
  for (int i = int(soughtLane()); i < 27; i += int(SOUGHT_LANES)) {
    uint facet =
        facetBesideIn(surface, reverse, dims, cell + ivec3(i % 3, (i / 3) % 3, i / 9) - 1, from, found.rank);
    if (facet != NO_FACET) found.facet = facet;
  }
  return found;
}

/// The facet of a point of a triangle's side: where rounding has put it into another voxel, in the next one; where no
/// surfel of the side is seen from p, that of the nearest surfel that is, in its voxel or else in the 27 around; where
/// none is seen in a crowd, a likely one. All invocations of a workgroup call it, those of pixels past the list's end with
/// `listed` false.
uint soughtFacet(SurfaceArrays surface, UintArray reverse, uvec3 dims, vec3 p, uint side, bool listed) {
  SurfelPoint point = SurfelPoint(p, vec3(0.0), 0u);
  Candidate mine = NO_CANDIDATE;
  if (listed) {
    point.triangle = firstInPlace(surface.corners, side & ~SURFEL_BACK);
    side = point.triangle | (side & SURFEL_BACK);
    point.facing = triangleFacing(surface, side);
    mine = foundByRounding(surface, reverse, dims, p, side);
  }
  uint found = bestOf(mine).facet;
  bool seeks = listed && found == NO_FACET;
  mine = NO_CANDIDATE;
  SidePoint from = SidePoint(point, seeks ? liftOf(surface, reverse, dims, point) : 0.0);
  if (seeks && soughtLane() == 0u)
    mine.facet = facetBesideIn(surface, reverse, dims, ivec3(floor(p)), from, mine.rank);
  uint inVoxel = bestOf(mine).facet;
  if (seeks) found = inVoxel;
  seeks = seeks && found == NO_FACET;
  uint around = bestOf(seeks ? foundAround(surface, reverse, dims, from) : NO_CANDIDATE).facet;
  if (seeks) found = around;
  if (seeks && found == NO_FACET) found = facetInCrowd(surface, reverse, dims, ivec3(floor(p)), point);
  return found;
}

#endif
