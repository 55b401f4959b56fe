// Points that stand for what lies outside the grid (docs/method.md 4), as their light is gathered.
#include "gi/seen_point.glsl"

/// A share of a lattice's step by which its points lie off their triangle's edges, on which others may stand.
const float INSET = 0.1f;

/// A point of a triangle that has a part outside the grid; where it lies inside, the nearest of those at the grid's border on
/// the ways to the triangle's corners. Inside, what the grid is about may stand on it, and its shade is none of that which
/// the point stands for.
vec3 outOfGrid(uvec3 dims, Triangle t, vec3 at) {
  vec3 end = vec3(dims);
  if (any(lessThan(at, vec3(0.0f))) || any(greaterThanEqual(at, end))) return at;
  vec3 corners[3] = vec3[3](t.a, t.b, t.c), found = at;
  float least = 1e30f;
  for (uint k = 0u; k < 3u; ++k) {
    vec3 way = corners[k] - at;
    float share = 1e30f;
    for (int axis = 0; axis < 3; ++axis)
      if (way[axis] != 0.0f) share = min(share, ((way[axis] > 0.0f ? end[axis] : 0.0f) - at[axis]) / way[axis]);
    if (share > 1.0f || share * length(way) >= least) continue;
    least = share * length(way);
    found = at + share * way;
  }
  return found;
}

SurfelPoint liftedPoint(SurfaceArrays surface, OuterArrays outer, uvec3 dims, OuterPoint point) {
  uint triangle = point.side & ~SURFEL_BACK, edges = outer.lattice.at[triangle].edges;
  Triangle t = triangleAt(surface.corners, triangle);
  vec2 at = vec2(1.0f / 3.0f);
  if (edges > 0u) {
    at = vec2(float(point.place & 0xFFFFu), float(point.place >> 16)) / float(edges);
    at += (vec2(1.0f / 3.0f) - at) * (INSET / float(edges));
  }
  vec3 facing = facingOf(t, (point.side & SURFEL_BACK) != 0u);
  vec3 position = outOfGrid(dims, t, t.a + at.x * (t.b - t.a) + at.y * (t.c - t.a));
  return SurfelPoint(liftedOff(surface, triangle, position, facing), facing, triangle);
}

/// Places on emitters are drawn by this density, 1 / voxels^2. `power`: of all that emits (EmitterTable::power).
float emitterDensity(vec3 exitance, float sides, float power) { return luminance(exitance) * sides / power; }

/// The distance^2 from which on an emitter is left to places drawn on it, voxels^2: there they are as dense, seen from a
/// point, as directions are straight up. Nearer than that it fills much of what the point sees.
float farFrom2(float density) { return 1.0f / (IRAD_PI * density); }
