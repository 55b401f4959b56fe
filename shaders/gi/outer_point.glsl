// Points that stand for what lies outside the grid (docs/method.md 4), as their light is gathered.
#include "gi/seen_point.glsl"

/// A share of a lattice's step by which its points lie off their triangle's edges, on which others may stand.
const float INSET = 0.1f;

SurfelPoint liftedPoint(SurfaceArrays surface, OuterArrays outer, OuterPoint point) {
  uint triangle = point.side & ~SURFEL_BACK, edges = outer.lattice.at[triangle].edges;
  Triangle t = triangleAt(surface.corners, triangle);
  vec2 at = vec2(1.0f / 3.0f);
  if (edges > 0u) {
    at = vec2(float(point.place & 0xFFFFu), float(point.place >> 16)) / float(edges);
    at += (vec2(1.0f / 3.0f) - at) * (INSET / float(edges));
  }
  vec3 facing = facingOf(t, (point.side & SURFEL_BACK) != 0u);
  vec3 position = t.a + at.x * (t.b - t.a) + at.y * (t.c - t.a);
  return SurfelPoint(liftedOff(surface, triangle, position, facing), facing, triangle);
}

/// Places on emitters are drawn by this density, 1 / voxels^2. `power`: of all that emits (EmitterTable::power).
float emitterDensity(vec3 exitance, float sides, float power) { return luminance(exitance) * sides / power; }

/// The distance^2 from which on an emitter is left to places drawn on it, voxels^2: there they are as dense, seen from a
/// point, as directions are straight up. Nearer than that it fills much of what the point sees.
float farFrom2(float density) { return 1.0f / (IRAD_PI * density); }
