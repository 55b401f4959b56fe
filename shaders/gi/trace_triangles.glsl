// Hit rule `triangles` (docs/method.md 5): a ray is met by the first triangle of the scene. Cells that hold none are
// stepped over; in a solid cell its pieces' triangles are asked. Included by gi/trace.glsl.
#include "gi/seen_in_voxel.glsl"
#include "shared/surface.h"

struct SurfelPoint {
  vec3 position, facing;  ///< voxel units, just above the surface
  uint triangle;
};

/// How far a ray starts above its triangle, as a share of the coordinates: eight times what these round to.
const float START_LIFT = 8.0 / 16777216.0;

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

/// A surfel of the facet, for u uniform in (0, 1); lifted off its triangle.
SurfelPoint surfelPoint(SurfaceArrays surface, uint facet, float u) {
  SurfelPoint p = surfelOf(surface, surface.surfels.at[FACET_SURFELS * facet + uint(u * float(FACET_SURFELS))]);
  vec3 size = abs(p.position);
  p.position += p.facing * (START_LIFT * max(1.0, max(size.x, max(size.y, size.z))));
  return p;
}

/// The facet of a split piece's side at a point of it: that of the nearest surfel which is seen from there.
uint splitFacet(SurfaceArrays surface, VoxelPieces voxel, uint entry, uint side, vec3 point, vec3 facing) {
  uint first = firstFacet(entry) * FACET_SURFELS, end = first + facetsOf(entry) * FACET_SURFELS;
  uint triangle = side & ~SURFEL_BACK;
  uint facet = TRACE_BLOCKED;
  float nearest = 1e30;
  for (uint i = first; i < end; ++i) {
    Surfel s = surface.surfels.at[i];
    if (s.triangle != side) continue;
    SurfelPoint p = surfelOf(surface, s);
    vec3 d = p.position - point;
    if (dot(d, d) >= nearest || !sameSide(voxel, point, facing, triangle, p.position, p.facing, triangle)) continue;
    nearest = dot(d, d);
    facet = i / FACET_SURFELS;
  }
  return facet;
}

/// The first triangle along a ray but `own`, from which the ray starts; hit.facet is TRACE_BLOCKED for the back of a
/// single-sided face.
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
    for (uint i = surface.firstPiece.at[facet]; i < end; ++i) {
      uint triangle = surface.pieces.at[i];
      if (triangle == own) continue;
      float t;
      bool front;
      if (!meetsTriangle(ray, surface.corners.at[3u * triangle], surface.corners.at[3u * triangle + 1u],
                         surface.corners.at[3u * triangle + 2u], t, front))
        continue;
      if (t <= 0.0f || t > nearest || (t == nearest && triangle > met)) continue;
      nearest = t;
      met = triangle;
      metPiece = i;
      metEntry = entry;
      metFront = front;
    }
    vec3 bounds = traceBounds(w, 1.0f);
    if (nearest <= min(bounds.x, min(bounds.y, bounds.z))) break;
    traceAdvance(w, 1.0f);
    ++hit.steps;
  }
  if (met == 0xFFFFFFFFu) return hit;
  hit.t = nearest;
  uint sides = surface.sides.at[metPiece];
  uint side = metFront ? sides & 0xFFFFu : sides >> 16;
  hit.facet = side == PIECE_BLACK ? TRACE_BLOCKED : firstFacet(metEntry) + side;
  if (side == PIECE_SPLIT) {
    uint first = firstFacet(metEntry);
    VoxelPieces voxel = VoxelPieces(surface.corners, surface.pieces, surface.firstPiece.at[first],
                                    surface.firstPiece.at[first + facetsOf(metEntry)]);
    vec3 a = surface.corners.at[3u * met];
    vec3 facing = normalize(cross(surface.corners.at[3u * met + 1u] - a, surface.corners.at[3u * met + 2u] - a));
    hit.facet = splitFacet(surface, voxel, metEntry, met | (metFront ? 0u : SURFEL_BACK), origin + w.direction * nearest,
                           metFront ? facing : -facing);
  }
  return hit;
}
