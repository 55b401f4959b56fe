// Indirect light outside the grid (docs/method.md 7): from the points of the triangle that is seen, linearly between them.
#include "gi/surface_point.h"

/// Whether a point has no voxel, and light by points.
bool beyondGrid(SurfaceArrays surface, uvec3 dims, vec3 p) {
  return uint64_t(surface.outer) != 0ul && (any(lessThan(p, vec3(0.0))) || any(greaterThanEqual(p, vec3(dims))));
}

/// `side`: as Surfel::triangle.
vec3 outerIrradiance(SurfaceArrays surface, uint side, vec3 p) {
  OuterArrays outer = surface.outer.at[0];
  uint triangle = firstInPlace(surface.corners, side & ~SURFEL_BACK);
  bool back = (side & SURFEL_BACK) != 0u;
  OuterLattice lattice = outer.lattice.at[triangle];
  if (lattice.first == NO_LATTICE || (back && !showsBack(surface.corners, triangle))) return vec3(0.0);
  uint edges = lattice.edges, first = lattice.first + (back ? latticePoints(edges) : 0u);
  if (edges == 0u) return outer.irradiance.at[first].xyz;
  Triangle t = triangleAt(surface.corners, triangle);
  vec2 s = clamp(barycentricOf(t.a, t.b, t.c, p), vec2(0.0), vec2(1.0)) * float(edges);
  s *= min(1.0, float(edges) / max(s.x + s.y, 1e-6));
  vec2 cell = min(floor(s), vec2(float(edges - 1u)));
  vec2 f = s - cell;
  // The lower half of the lattice's cell, or the upper one.
  uint i = uint(cell.x), j = uint(cell.y);
  bool upper = f.x + f.y > 1.0 && i + j + 2u <= edges;
  uint corner = upper ? latticeIndex(edges, i + 1u, j + 1u) : latticeIndex(edges, i, min(j, edges - i));
  vec3 sum = outer.irradiance.at[first + corner].xyz * abs(1.0 - f.x - f.y);
  vec2 w = upper ? vec2(1.0) - f.yx : f;
  uint x = i + j < edges ? latticeIndex(edges, i + 1u, j) : corner, y = i + j < edges ? latticeIndex(edges, i, j + 1u) : corner;
  return sum + w.x * outer.irradiance.at[first + x].xyz + w.y * outer.irradiance.at[first + y].xyz;
}
