// Hit rule `triangles` (docs/method.md 5): a ray is met by the first triangle of the scene. Cells that hold none are
// stepped over; in a solid cell its pieces' triangles are asked. Included by gi/trace.glsl.
#include "gi/piece_cuts.glsl"
#include "gi/triangle_hit.glsl"
#include "gi/surface_point.glsl"
#include "shared/surface.h"

/// Ray k of a facet: from one of its surfels, lifted off the triangle.
struct FacetRay {
  SurfelPoint from;
  vec3 direction;
};

/// A surfel of the facet, lifted off its triangle.
SurfelPoint liftedSurfel(SurfaceArrays surface, uint facet, uint k) {
  SurfelPoint p = surfelOf(surface, facet, k);
  p.position = liftedStart(p.position, p.facing);
  return p;
}

FacetRay facetRay(SurfaceArrays surface, uint facet, uint packedVoxel, uint k, uint rays, uint seed, uint jitter) {
  uvec4 shifts = rayShifts(packedVoxel, seed, jitter);
  FacetRay ray;
  ray.from = liftedSurfel(surface, facet, raySurfel(k, shifts));
  ray.direction = rayDirection(ray.from.facing, k, rays, shifts);
  return ray;
}

/// What a ray meets first.
struct TriangleHit {
  uint triangle;      ///< NO_TRIANGLE: nothing
  uint piece, entry;  ///< in the voxel where it was found, whose entry of the reverse map
  bool front;
  float t;
  uint steps;  ///< cells visited
};
const uint NO_TRIANGLE = 0xFFFFFFFFu;

/// A ray on its way: the cell that it is in, and of the pieces there the next one to ask.
struct TriangleWalk {
  TraceWalk at;
  ShearedRay ray;
  uint own;  ///< the triangle that it leaves
  uint piece, endPiece, entry;
  float leave;    ///< where it leaves the cell
  float nearest;  ///< at which the hit counts as met: its t, or later (backDelay)
  TriangleHit hit;
};

TriangleWalk startTriangles(vec3 origin, vec3 direction, uint own, float reach) {
  TriangleWalk w;
  w.at = traceStart(origin, direction);
  w.ray = shearedRay(origin, w.at.direction);
  w.own = own;
  w.piece = w.endPiece = 0u;
  w.entry = NO_FACET;
  w.leave = 0.0f;
  w.nearest = reach;
  w.hit = TriangleHit(NO_TRIANGLE, 0u, 0u, false, reach, 0u);
  return w;
}

/// Whether a mask leaves the piece where the ray meets it: what has holes is there only where this cell's piece is.
bool leavesMask(SurfaceArrays surface, TriangleWalk w, uint triangle, float t) {
  if (!hasHoles(surface.corners, triangle)) return true;
  vec3 normal = facingOf(triangleAt(surface.corners, triangle), false);
  return t >= w.at.t && t <= w.leave &&
         isThere(surface, w.piece, normal, w.at.origin + w.at.direction * t - w.at.cell);
}

/// Where a meeting that is as near as the hit counts as met. What shows a side costs no further read.
float countsAt(TraceWorld world, SurfaceArrays surface, TriangleWalk w, uint triangle, float t, bool front) {
  if (front || showsBack(surface.corners, triangle)) return t;
  return t + backDelay(world.dims, dot(facingOf(triangleAt(surface.corners, triangle), false), w.at.direction));
}

/// Asks the next piece, or goes on to the next cell that may hold one; false: the ray has met what it meets. Steps of
/// equal length, so that rays side by side wait little for each other.
bool stepTriangles(TraceWorld world, SurfaceArrays surface, inout TriangleWalk w) {
  if (w.piece < w.endPiece) {
    uint triangle = triangleOf(surface.pieces, w.piece);
    float t;
    bool front;
    if (triangle != w.own && meetsTriangle(w.ray, triangleAt(surface.corners, triangle), t, front) && t > 0.0f &&
        t <= w.nearest && leavesMask(surface, w, triangle, t)) {
      float at = countsAt(world, surface, w, triangle, t, front);
      if (at < w.nearest || (at == w.nearest && triangle <= w.hit.triangle)) {
        w.nearest = at;
        w.hit = TriangleHit(triangle, w.piece, w.entry, front, t, w.hit.steps);
      }
    }
    if (++w.piece < w.endPiece) return true;
    if (w.nearest <= w.leave) return false;
    traceAdvance(w.at, 1.0f);
    ++w.hit.steps;
  }
  // What was met beyond a cell's end waits until no cell before it is left.
  if (!traceInside(w.at, world.dims) || w.nearest <= w.at.t) return false;
  float clearance = traceClearance(world, w.at.cell);
  if (clearance > 0.0f) {
    traceAdvance(w.at, clearance);
    ++w.hit.steps;
    return true;
  }
  w.entry = world.facets.reverse.at[traceIndex(w.at.cell, world.dims)];
  w.piece = surface.firstPiece.at[firstFacet(w.entry)];
  w.endPiece = surface.firstPiece.at[firstFacet(w.entry) + facetsOf(w.entry)];
  vec3 bounds = traceBounds(w.at, 1.0f);
  w.leave = min(bounds.x, min(bounds.y, bounds.z));
  return true;
}

/// The first triangle nearer than `reach` along a ray, but `own`, from which the ray starts.
TriangleHit firstTriangle(TraceWorld world, SurfaceArrays surface, vec3 origin, vec3 direction, uint own, float reach) {
  TriangleWalk w = startTriangles(origin, direction, own, reach);
  while (stepTriangles(world, surface, w)) {}
  return w.hit;
}

/// The facet that a ray has met; TRACE_ESCAPED, TRACE_BLOCKED at the back of a single-sided face, or TRACE_INVALID where it
/// is not known which facet (PIECE_UNKNOWN).
TraceHit facetMet(SurfaceArrays surface, TriangleHit hit, vec3 origin, vec3 direction) {
  if (hit.triangle == NO_TRIANGLE) return TraceHit(TRACE_ESCAPED, 0.0f, hit.steps);
  uint found = classAt(surface, hit.piece, !hit.front, origin + direction * hit.t);
  uint facet = found < PIECE_UNKNOWN ? firstFacet(hit.entry) + found
                                     : (found == PIECE_BLACK ? TRACE_BLOCKED : TRACE_INVALID);
  return TraceHit(facet, hit.t, hit.steps);
}

/// The same of the first triangle along a ray but `own`.
TraceHit traceTriangles(TraceWorld world, SurfaceArrays surface, vec3 origin, vec3 direction, uint own) {
  return facetMet(surface, firstTriangle(world, surface, origin, direction, own, 1e30f), origin, direction);
}
