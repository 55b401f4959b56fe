// The facet of a point of the surface where its piece does not tell it (docs/method.md 7): as of one pixel in thirty
// thousand of simple scenes, and of many where much is in a voxel. Some invocations share the search for a pixel: one alone
// would take longer than all others together for the rest of the picture.
#ifndef IRAD_SOUGHT_FACET_GLSL
#define IRAD_SOUGHT_FACET_GLSL
#include "gi/surface_lookup.glsl"
#include "shared/constants.h"
#include "shared/picked.h"

layout(constant_id = CONSTANT_SOUGHT_LANES) const uint SOUGHT_LANES = 32u;  ///< of 1, 32

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

/// How far on the way to the viewer pixels are asked for, voxels: enough for what stands beside them to be in no doubt.
const float NEARER = 8.0 * CUT_WIDTH;

/// A lane's candidate where rounding has put a point of a triangle's side into another voxel: the first of the next ones
/// in which the triangle has a piece there. What stands on it is asked `nearer` to the viewer, to whom the way is clear: of a
/// floor at the foot of a wall a pixel may be drawn that lies a rounding behind the wall, in the dark.
Candidate foundByRounding(SurfaceArrays surface, UintArray reverse, uvec3 dims, vec3 p, vec3 nearer, uint side) {
  const float ROUNDING = 1e-2;
  ivec3 cell = ivec3(floor(p));
  vec3 inside = p - vec3(cell);
  ivec3 beside = ivec3(greaterThan(inside, vec3(1.0 - ROUNDING))) - ivec3(lessThan(inside, vec3(ROUNDING)));
  for (uint i = soughtLane(); i < 8u; i += SOUGHT_LANES) {
    ivec3 corner = ivec3(i & 1u, (i >> 1) & 1u, i >> 2);
    if (corner * abs(beside) != corner) continue;
    uint entry = entryOf(reverse, dims, cell + corner * beside);
    uint facet = entry == NO_FACET ? NO_FACET : facetInVoxel(surface, entry, nearer, side);
    if (facet != NO_FACET) return Candidate(facet, float(i));
  }
  return NO_CANDIDATE;
}

/// Facets of a cube of voxels, one after the other: a lane's share of them is each SOUGHT_LANES-th.
struct FacetsAround {
  ivec3 low;  ///< the cube's first voxel
  int edge;   ///< voxels
  int voxel, endVoxel;
  uint first, count;  ///< facets of the voxel
  uint before, item;  ///< facets of voxels before it; the lane's next one, counted from the first of all
};
FacetsAround facetsAround(ivec3 low, int edge, int voxel, int endVoxel) {
  return FacetsAround(low, edge, voxel - 1, endVoxel, 0u, 0u, 0u, soughtLane());
}
/// The lane's next facet, NO_FACET after its last one.
uint nextFacet(UintArray reverse, uvec3 dims, inout FacetsAround f) {
  while (f.item >= f.before + f.count) {
    if (++f.voxel >= f.endVoxel) return NO_FACET;
    f.before += f.count;
    uint entry =
        entryOf(reverse, dims, f.low + ivec3(f.voxel % f.edge, (f.voxel / f.edge) % f.edge, f.voxel / (f.edge * f.edge)));
    f.first = entry == NO_FACET ? 0u : firstFacet(entry);
    f.count = entry == NO_FACET ? 0u : facetsOf(entry);
  }
  uint facet = f.first + f.item - f.before;
  f.item += SOUGHT_LANES;
  return facet;
}

/// A lane's candidate by its distance: of its share of the cube's facets the one whose nearest surfel is nearest to a point
/// of the surface, on its side. They are asked the nearest first: looking for that is little beside `continues`. A lane by
/// itself takes a voxel at a time. What is no nearer than `found` is not asked.
Candidate foundIn(SurfaceArrays surface, UintArray reverse, uvec3 dims, ivec3 low, int edge, SidePoint from,
                  Candidate found) {
  SurfelPoint p = from.at;
  int voxels = edge * edge * edge, atOnce = SOUGHT_LANES == 1u ? 1 : voxels;
  for (int voxel = 0; voxel < voxels; voxel += atOnce) {
    float asked = -1.0;  // the distance of the last that was asked
    uint last = 0u;      // and which it was
    for (;;) {
      float best = found.rank;
      uint next = NO_FACET, nextItem = 0u;
      SurfelPoint to;
      FacetsAround facets = facetsAround(low, edge, voxel, voxel + atOnce);
      for (uint facet; (facet = nextFacet(reverse, dims, facets)) != NO_FACET;) {
        float distance2;
        SurfelPoint s = nearestSurfel(surface, facet, p.position, distance2);
        if (distance2 >= best || distance2 < asked || (distance2 == asked && facets.item <= last) || !mayContinue(p, s))
          continue;
        best = distance2;
        next = facet;
        nextItem = facets.item;
        to = s;
      }
      if (next == NO_FACET) break;
      if (continues(surface, reverse, dims, from, SidePoint(to, liftOf(surface, reverse, dims, to)))) {
        found = Candidate(next, best);
        break;
      }
      asked = best;
      last = nextItem;
    }
  }
  return found;
}

/// The side of the triangle that has the pieces, and a point there.
SurfelPoint soughtPoint(SurfaceArrays surface, vec3 p, inout uint side) {
  uint triangle = firstInPlace(surface.corners, side & ~SURFEL_BACK);
  side = triangle | (side & SURFEL_BACK);
  return SurfelPoint(p, triangleFacing(surface, side), triangle);
}

/// The facet of a point of a triangle's side, seen from the direction `viewer`: where rounding has put it into another
/// voxel, in the next one; where no surfel of the side is seen from p, that of the nearest surfel that is, in its voxel or
/// else in the 27 around; where none is seen in a crowd, a likely one. All invocations of a workgroup call it, those of
/// pixels past the list's end with `listed` false.
uint soughtFacet(SurfaceArrays surface, UintArray reverse, uvec3 dims, vec3 p, vec3 viewer, uint side, bool listed) {
  SurfelPoint point = SurfelPoint(p, vec3(0.0), 0u);
  Candidate mine = NO_CANDIDATE;
  if (listed) {
    point = soughtPoint(surface, p, side);
    mine = foundByRounding(surface, reverse, dims, p, p + NEARER * viewer, side);
  }
  uint found = bestOf(mine).facet;
  bool seeks = listed && found == NO_FACET;
  SidePoint from = SidePoint(point, seeks ? liftOf(surface, reverse, dims, point) : 0.0);
  ivec3 cell = ivec3(floor(p));
  uint inVoxel = bestOf(seeks ? foundIn(surface, reverse, dims, cell, 1, from, NO_CANDIDATE) : NO_CANDIDATE).facet;
  if (seeks) found = inVoxel;
  seeks = seeks && found == NO_FACET;
  uint around = bestOf(seeks ? foundIn(surface, reverse, dims, cell - 1, 3, from, NO_CANDIDATE) : NO_CANDIDATE).facet;
  if (seeks) found = around;
  if (seeks && found == NO_FACET) found = facetInCrowd(surface, reverse, dims, cell, point);
  return found;
}

/// The same by parts (SOUGHT_PARTS): the best that is known after one of them, of what was known before it. It is over
/// with the first part where that finds one, and with the last.
Candidate soughtInPart(SurfaceArrays surface, UintArray reverse, uvec3 dims, vec3 p, vec3 viewer, uint side, uint part,
                       Candidate known) {
  SurfelPoint point = soughtPoint(surface, p, side);
  ivec3 cell = ivec3(floor(p)), low = cell;
  if (part == 0u) {
    known = foundByRounding(surface, reverse, dims, p, p + NEARER * viewer, side);
    if (known.facet != NO_FACET) return known;
  } else {
    int voxel = int(part) - 1;
    low += ivec3(voxel % 3, (voxel / 3) % 3, voxel / 9) - 1;
  }
  SidePoint from = SidePoint(point, liftOf(surface, reverse, dims, point));
  known = foundIn(surface, reverse, dims, low, 1, from, known);
  if (part + 1u == SOUGHT_PARTS && known.facet == NO_FACET)
    known.facet = facetInCrowd(surface, reverse, dims, cell, point);
  return known;
}

#endif
