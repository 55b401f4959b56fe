// A triangle as the voxelizers see it: in voxel units, with its facing and its cells along the dominant axis.
#ifndef IRAD_VOXEL_TRIANGLE_H
#define IRAD_VOXEL_TRIANGLE_H
#include "shared/grid.h"
#include "shared/scene_gpu.h"
IRAD_BEGIN

struct VoxelTriangle {
  vec3 v[3];    ///< voxel units
  vec3 normal;  ///< (v1 - v0) x (v2 - v0); zero when the triangle is degenerate
  uint axis;    ///< dominant axis: the largest |normal| component (T eq. 11), the first of equals
};

/// Degenerate: thinner than the rounding of its own coordinates (4 ulp), so that its facing is noise; or not finite.
IRAD_FN VoxelTriangle loadTriangle(SceneArray scenes, GridArray grids, uint triangle) {
  Vec3Array positions = scenes.at[0].positions;
  UintArray indices = scenes.at[0].indices;
  vec3 p0 = positions.at[indices.at[3u * triangle]];
  vec3 p1 = positions.at[indices.at[3u * triangle + 1u]];
  vec3 p2 = positions.at[indices.at[3u * triangle + 2u]];
  vec3 origin = grids.at[0].origin;
  float inverseEdge = grids.at[0].inverseEdge;
  VoxelTriangle t;
  t.v[0] = (p0 - origin) * inverseEdge;
  t.v[1] = (p1 - origin) * inverseEdge;
  t.v[2] = (p2 - origin) * inverseEdge;
  // The facing from differences of the stored positions. `precise`: every pass must choose the same axis.
  vec3 a = (p1 - p0) * inverseEdge;
  vec3 b = (p2 - p0) * inverseEdge;
  vec3 c = b - a;
  IRAD_PRECISE vec3 n = vec3(a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x);
  IRAD_PRECISE float area2 = n.x * n.x + n.y * n.y + n.z * n.z;
  IRAD_PRECISE float longest2 = max(a.x * a.x + a.y * a.y + a.z * a.z,
                               max(b.x * b.x + b.y * b.y + b.z * b.z, c.x * c.x + c.y * c.y + c.z * c.z));
  vec3 size = max(abs(p0), max(abs(p1), abs(p2)));
  IRAD_PRECISE float ulp = max(size.x, max(size.y, size.z)) * inverseEdge * (4.0f / 8388608.0f);
  t.normal = area2 > longest2 * ulp * ulp && area2 < 1e30f ? n : vec3(0.0f);
  vec3 m = abs(n);
  t.axis = m.x >= m.y && m.x >= m.z ? 0u : (m.y >= m.z ? 1u : 2u);
  return t;
}

IRAD_FN bool degenerate(VoxelTriangle t) { return t.normal == vec3(0.0f); }

/// The cells [lo, hi] that the triangle's bounds touch; false when none is in the grid (a wall at p == max of a grid
/// without padding: thesis.literal). Cells are half-open: a wall on a cell face lies in one cell.
IRAD_FN bool cellBounds(VoxelTriangle t, uvec3 dims, IRAD_INOUT(ivec3) lo, IRAD_INOUT(ivec3) hi) {
  lo = max(ivec3(floor(min(t.v[0], min(t.v[1], t.v[2])))), ivec3(0));
  hi = min(ivec3(floor(max(t.v[0], max(t.v[1], t.v[2])))), ivec3(dims) - 1);
  return all(lessThanEqual(lo, hi));
}

/// Axes rotated so that `axis` becomes z (the other two follow in cyclic order), and back.
IRAD_FN vec3 dominantLast(vec3 v, uint axis) {
  return axis == 0u ? vec3(v.y, v.z, v.x) : (axis == 1u ? vec3(v.z, v.x, v.y) : v);
}
IRAD_FN ivec3 dominantLast(ivec3 v, uint axis) {
  return axis == 0u ? ivec3(v.y, v.z, v.x) : (axis == 1u ? ivec3(v.z, v.x, v.y) : v);
}
IRAD_FN vec3 originalAxes(vec3 v, uint axis) {
  return axis == 0u ? vec3(v.z, v.x, v.y) : (axis == 1u ? vec3(v.y, v.z, v.x) : v);
}
IRAD_FN ivec3 originalAxes(ivec3 v, uint axis) {
  return axis == 0u ? ivec3(v.z, v.x, v.y) : (axis == 1u ? ivec3(v.y, v.z, v.x) : v);
}

IRAD_END
#endif
