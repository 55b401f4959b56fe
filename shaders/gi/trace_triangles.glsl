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

/// The first triangle along a ray but `own`, from which the ray starts. A facet, TRACE_ESCAPED, TRACE_BLOCKED at the
/// back of a single-sided face, or TRACE_INVALID where it is not known which facet (PIECE_UNKNOWN).
TraceHit traceTriangles(TraceWorld world, SurfaceArrays surface, vec3 origin, vec3 direction, uint own) {
  TraceWalk w = traceStart(origin, direction);
  ShearedRay ray = shearedRay(origin, w.direction);
  TraceHit hit = TraceHit(TRACE_ESCAPED, 0.0f, 0u);
  float nearest = 1e30f;
  uint met = 0xFFFFFFFFu, metPiece = 0u, metEntry = 0u;
  bool metFront = false;
  while (traceToSolid(world, w, hit.steps)) {
    // What was met beyond a cell's end waits until no cell before it is left.
    if (nearest <= w.t) break;
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
      if (t <= 0.0f || t > nearest || (t == nearest && triangle > met)) continue;
      // What has holes is there only where this cell's piece is.
      if (hasHoles(surface.corners, triangle)) {
        vec3 normal = facingOf(triangleAt(surface.corners, triangle), false);
        if (t < w.t || t > leave || !isThere(surface, i, normal, origin + w.direction * t - vec3(w.cell))) continue;
      }
      nearest = t;
      met = triangle;
      metPiece = i;
      metEntry = entry;
      metFront = front;
    }
    if (nearest <= leave) break;
    traceAdvance(w, 1.0f);
    ++hit.steps;
  }
  if (met == 0xFFFFFFFFu) return hit;
  hit.t = nearest;
  uint found = classAt(surface, metPiece, !metFront, origin + w.direction * nearest);
  hit.facet = found < PIECE_UNKNOWN ? firstFacet(metEntry) + found
                                    : (found == PIECE_BLACK ? TRACE_BLOCKED : TRACE_INVALID);
  return hit;
}
