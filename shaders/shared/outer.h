// What lies outside the region that has voxels (docs/method.md 2): its triangles in a tree of boxes, and points of them
// that stand for what is around each, as the bins of a sky do for directions.
#ifndef IRAD_SHARED_OUTER_H
#define IRAD_SHARED_OUTER_H
#include "shared/types.h"
IRAD_BEGIN

/// Of a tree that is kept in the order in which it is walked: what is below a node lies behind it. Voxel units.
struct OuterNode {
  vec3 lo;
  uint next;  ///< the node behind all that is below this one
  vec3 hi;
  uint leaf;  ///< 0, or the place of its first triangle in OuterArrays::order << OUTER_LEAF_BITS | how many
};
IRAD_ARRAY(OuterNodeArray, OuterNode, 16)
IRAD_CONST uint OUTER_LEAF_BITS = 3u;
IRAD_CONST uint OUTER_LEAF = 4u;  ///< triangles at most

/// The points of a triangle: its middle, or a lattice that divides each of its edges into so many parts.
struct OuterLattice {
  uint first;  ///< of its front; where its back shows, that one's are behind them. NO_LATTICE: it has no part outside
  uint edges;  ///< 0: its middle alone
};
IRAD_ARRAY(OuterLatticeArray, OuterLattice, 8)
IRAD_CONST uint NO_LATTICE = 0xFFFFFFFFu;
struct OuterPoint {
  uint side;   ///< a triangle, | SURFEL_BACK
  uint place;  ///< steps from the first corner towards the second | << 16 towards the third
};
IRAD_ARRAY(OuterPointArray, OuterPoint, 8)

struct OuterArrays {
  OuterNodeArray nodes;
  UintArray order;             ///< triangles of the leaves
  OuterLatticeArray lattice;   ///< per triangle of the scene
  OuterPointArray points;
  Vec3Array albedo, exitance;  ///< per triangle of the scene; exitance W/m^2
  Vec4Array irradiance;        ///< per point: what comes from the sky and from what emits, W/m^2
  Vec4Array bins;              ///< radiance: of the sky's bins, then of the points
  uint nodeCount, pointCount;
};
IRAD_ARRAY(OuterRecord, OuterArrays, 16)

IRAD_FN uint latticePoints(uint edges) { return edges == 0u ? 1u : (edges + 1u) * (edges + 2u) / 2u; }
IRAD_FN uint latticeIndex(uint edges, uint i, uint j) { return i + j * (2u * edges + 3u - j) / 2u; }
/// `at`: the shares of the second and the third corner.
IRAD_FN uint nearestLattice(uint edges, vec2 at) {
  if (edges == 0u) return 0u;
  vec2 s = clamp(at, vec2(0.0f), vec2(1.0f)) * float(edges);
  vec2 r = floor(s + vec2(0.5f));
  if (r.x + r.y > float(edges)) {
    if (r.x - s.x > r.y - s.y)
      r.x -= 1.0f;
    else
      r.y -= 1.0f;
  }
  r = clamp(r, vec2(0.0f), vec2(float(edges)));
  return latticeIndex(edges, uint(r.x), min(uint(r.y), edges - uint(r.x)));
}
IRAD_FN vec2 barycentricOf(vec3 a, vec3 b, vec3 c, vec3 p) {
  vec3 n = cross(b - a, c - a);
  float whole = max(dot(n, n), 1e-30f);
  return vec2(dot(cross(p - a, c - a), n), dot(cross(b - a, p - a), n)) / whole;
}

/// Where a ray enters and leaves the part of the grid whose voxels it asks, which ends half a voxel before the grid;
/// (1e30, -1e30) where it passes by. `inverse`: of a direction without zeros.
IRAD_FN vec2 throughGrid(uvec3 dims, vec3 origin, vec3 inverse) {
  vec3 a = (vec3(0.5f) - origin) * inverse, b = (vec3(dims) - vec3(0.5f) - origin) * inverse;
  vec3 near_ = min(a, b), far_ = max(a, b);
  float enter = max(near_.x, max(near_.y, near_.z)), leave = min(far_.x, min(far_.y, far_.z));
  return enter < leave ? vec2(enter, leave) : vec2(1e30f, -1e30f);
}

IRAD_END
#endif
