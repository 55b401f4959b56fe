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

/// The first triangle nearer than `reach` along a ray, but `own`, from which the ray starts.
TriangleHit firstTriangle(TraceWorld world, SurfaceArrays surface, vec3 origin, vec3 direction, uint own, float reach) {
  TraceWalk w = traceStart(origin, direction);
  ShearedRay ray = shearedRay(origin, w.direction);
  TriangleHit hit = TriangleHit(NO_TRIANGLE, 0u, 0u, false, reach, 0u);
  while (traceToSolid(world, w, hit.steps)) {
    // What was met beyond a cell's end waits until no cell before it is left.
    if (hit.t <= w.t) break;
    uint entry = world.facets.reverse.at[traceIndex(w.cell, world.dims)];
    uint facet = firstFacet(entry);
    uint end = surface.firstPiece.at[facet + facetsOf(entry)];
    vec3 bounds = traceBounds(w, 1.0f);
    float leave = min(bounds.x, min(bounds.y, bounds.z));
    for (uint i = surface.firstPiece.at[facet]; i < end; ++i) {
      uint triangle = triangleOf(surface.pieces, i);
      if (triangle == own) continue;
      float t;
      bool front;
      if (!meetsTriangle(ray, triangleAt(surface.corners, triangle), t, front)) continue;
      if (t <= 0.0f || t > hit.t || (t == hit.t && triangle > hit.triangle)) continue;
      // What has holes is there only where this cell's piece is.
      if (hasHoles(surface.corners, triangle)) {
        vec3 normal = facingOf(triangleAt(surface.corners, triangle), false);
        if (t < w.t || t > leave || !isThere(surface, i, normal, origin + w.direction * t - vec3(w.cell))) continue;
      }
      hit.triangle = triangle;
      hit.piece = i;
      hit.entry = entry;
      hit.front = front;
      hit.t = t;
    }
    if (hit.t <= leave) break;
    traceAdvance(w, 1.0f);
    ++hit.steps;
  }
  return hit;
}

/// The facet on the first triangle along a ray but `own`; TRACE_ESCAPED, TRACE_BLOCKED at the back of a single-sided
/// face, or TRACE_INVALID where it is not known which facet (PIECE_UNKNOWN).
TraceHit traceTriangles(TraceWorld world, SurfaceArrays surface, vec3 origin, vec3 direction, uint own) {
  TriangleHit hit = firstTriangle(world, surface, origin, direction, own, 1e30f);
  if (hit.triangle == NO_TRIANGLE) return TraceHit(TRACE_ESCAPED, 0.0f, hit.steps);
  uint found = classAt(surface, hit.piece, !hit.front, origin + direction * hit.t);
  uint facet = found < PIECE_UNKNOWN ? firstFacet(hit.entry) + found
                                     : (found == PIECE_BLACK ? TRACE_BLOCKED : TRACE_INVALID);
  return TraceHit(facet, hit.t, hit.steps);
}
