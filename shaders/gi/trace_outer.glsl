// Rays of the whole scene, from anywhere: through the grid and, before and behind it, past the triangles outside it
// (docs/method.md 5). Included by gi/trace.glsl.
#include "shared/outer.h"
#include "shared/sky.h"

/// The nearest triangle along a ray but `own`, before `reach` and not within `grid`, which has its own (throughGrid). Only
/// triangle, front and t are filled in. Masks are not looked up here.
TriangleHit outerTriangle(SurfaceArrays surface, vec3 origin, vec3 direction, uint own, vec2 grid, float reach) {
  OuterArrays outer = surface.outer.at[0];
  vec3 inverse = 1.0f / direction;
  ShearedRay ray = shearedRay(origin, direction);
  TriangleHit hit = TriangleHit(NO_TRIANGLE, 0u, 0u, false, reach, 0u);
  uint n = 0u;
  while (n < outer.nodeCount) {
    OuterNode node = outer.nodes.at[n];
    vec3 a = (node.lo - origin) * inverse, b = (node.hi - origin) * inverse;
    vec3 enter = min(a, b), leave = max(a, b);
    if (max(max(enter.x, enter.y), max(enter.z, 0.0f)) > min(min(leave.x, leave.y), min(leave.z, hit.t))) {
      n = node.next;
      continue;
    }
    ++n;
    uint first = node.leaf >> OUTER_LEAF_BITS;
    for (uint i = 0u; i < (node.leaf & ((1u << OUTER_LEAF_BITS) - 1u)); ++i) {
      uint triangle = outer.order.at[first + i];
      float t;
      bool front;
      if (triangle == own || !meetsTriangle(ray, triangleAt(surface.corners, triangle), t, front)) continue;
      if (t <= 0.0f || t >= hit.t || (t >= grid.x && t <= grid.y)) continue;
      hit.triangle = triangle;
      hit.front = front;
      hit.t = t;
    }
  }
  return hit;
}

/// The point outside the grid that stands for what is around `p` on a triangle's side: its number.
uint outerPoint(SurfaceArrays surface, OuterArrays outer, uint triangle, bool front, vec3 p) {
  OuterLattice lattice = outer.lattice.at[triangle];
  Triangle t = triangleAt(surface.corners, triangle);
  uint point = lattice.first + nearestLattice(lattice.edges, barycentricOf(t.a, t.b, t.c, p));
  return front ? point : point + latticePoints(lattice.edges);
}

/// The part of a ray within the grid, if there is one: where it begins.
bool entersGrid(vec2 grid, float reach, out float from) {
  from = max(grid.x, 0.0f);
  return grid.y > from && from < reach;
}

/// As traceTriangles, from anywhere; of what lies outside the grid metOuter(). Panes there tint nothing: they are met.
TraceHit traceScene(TraceWorld world, SurfaceArrays surface, vec3 origin, vec3 direction, uint own) {
  if (!hasOuter(surface)) return traceTriangles(world, surface, origin, direction, own);
  closedChannels = 0u;
  vec3 safe = safeDirection(direction);
  vec2 grid = throughGrid(world.dims, origin, 1.0f / safe);
  TraceHit inner = TraceHit(TRACE_ESCAPED, 0.0f, 0u);
  float from;
  if (entersGrid(grid, 1e30f, from)) {
    inner = traceTriangles(world, surface, origin + safe * from, direction, own);
    inner.t += from;
  }
  float reach = inner.facet == TRACE_ESCAPED ? 1e30f : inner.t;
  TriangleHit outer = outerTriangle(surface, origin, safe, own, grid, reach);
  if (outer.triangle == NO_TRIANGLE) return inner;
  if (outer.t <= max(grid.x, 0.0f)) closedChannels = 0u;  // it lies before the grid
  if (closedChannels == TINT_NONE_LEFT) return inner;
  if (!outer.front && !showsBack(surface.corners, outer.triangle)) return TraceHit(TRACE_BLOCKED, outer.t, inner.steps);
  uint point = outerPoint(surface, surface.outer.at[0], outer.triangle, outer.front, origin + safe * outer.t);
  return TraceHit(metOuter(point), outer.t, inner.steps);
}

/// Whether a ray from anywhere meets something before `reach`, or has no channel left there (closedChannels).
bool blockedInScene(TraceWorld world, SurfaceArrays surface, vec3 origin, vec3 direction, uint own, float reach) {
  closedChannels = 0u;
  if (!hasOuter(surface))
    return firstTriangle(world, surface, origin, direction, own, reach).triangle != NO_TRIANGLE ||
           closedChannels == TINT_NONE_LEFT;
  vec3 safe = safeDirection(direction);
  vec2 grid = throughGrid(world.dims, origin, 1.0f / safe);
  float from;
  if (entersGrid(grid, reach, from) &&
      (firstTriangle(world, surface, origin + safe * from, direction, own, reach - from).triangle != NO_TRIANGLE ||
       closedChannels == TINT_NONE_LEFT))
    return true;
  return outerTriangle(surface, origin, safe, own, grid, reach).triangle != NO_TRIANGLE;
}
