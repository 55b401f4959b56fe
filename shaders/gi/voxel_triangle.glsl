// A triangle as the voxelizers see it: in voxel units, with its facing and its cells along the dominant axis.
#include "shared/voxelize.h"

struct VoxelTriangle {
  vec3 v[3];    ///< voxel units
  vec3 normal;  ///< (v1 - v0) x (v2 - v0); zero when the triangle is degenerate
  uint axis;    ///< dominant axis: the largest |normal| component (T eq. 11), the first of equals
};

/// Degenerate: thinner than the rounding of its own coordinates (4 ulp), so that its facing is noise; or not finite.
VoxelTriangle loadTriangle(SceneArray scenes, GridArray grids, uint triangle) {
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
  precise vec3 n = vec3(a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x);
  precise float area2 = n.x * n.x + n.y * n.y + n.z * n.z;
  precise float longest2 = max(a.x * a.x + a.y * a.y + a.z * a.z,
                               max(b.x * b.x + b.y * b.y + b.z * b.z, c.x * c.x + c.y * c.y + c.z * c.z));
  vec3 size = max(abs(p0), max(abs(p1), abs(p2)));
  precise float ulp = max(size.x, max(size.y, size.z)) * inverseEdge * (4.0 / 8388608.0);
  t.normal = area2 > longest2 * ulp * ulp && area2 < 1e30 ? n : vec3(0.0);
  vec3 m = abs(n);
  t.axis = m.x >= m.y && m.x >= m.z ? 0u : (m.y >= m.z ? 1u : 2u);
  return t;
}

bool degenerate(VoxelTriangle t) { return t.normal == vec3(0.0); }

uint triangleFlags(SceneArray scenes, uint triangle) {
  return scenes.at[0].materials.at[scenes.at[0].triangleMaterials.at[triangle]].flags;
}

/// The cells [lo, hi] that the triangle's bounds touch; false when none is in the grid (a wall at p == max of a grid
/// without padding: thesis.literal). Cells are half-open: a wall on a cell face lies in one cell.
bool cellBounds(VoxelTriangle t, uvec3 dims, out ivec3 lo, out ivec3 hi) {
  lo = max(ivec3(floor(min(t.v[0], min(t.v[1], t.v[2])))), ivec3(0));
  hi = min(ivec3(floor(max(t.v[0], max(t.v[1], t.v[2])))), ivec3(dims) - 1);
  return all(lessThanEqual(lo, hi));
}

/// Axes rotated so that `axis` becomes z (the other two follow in cyclic order), and back.
vec3 dominantLast(vec3 v, uint axis) { return axis == 0u ? v.yzx : (axis == 1u ? v.zxy : v); }
ivec3 dominantLast(ivec3 v, uint axis) { return axis == 0u ? v.yzx : (axis == 1u ? v.zxy : v); }
vec3 originalAxes(vec3 v, uint axis) { return axis == 0u ? v.zxy : (axis == 1u ? v.yzx : v); }
ivec3 originalAxes(ivec3 v, uint axis) { return axis == 0u ? v.zxy : (axis == 1u ? v.yzx : v); }

/// A triangle projected along its dominant axis.
struct FlatTriangle {
  uint triangle;
  uint axis;    ///< | RASTER_FACES_UP
  vec3 plane;   ///< depth = plane.z + plane.xy . (pixel - corner)
  vec2 corner;  ///< the first
};

FlatTriangle flatTriangle(VoxelTriangle t, uint triangle) {
  vec3 n = dominantLast(t.normal, t.axis);
  vec3 first = dominantLast(t.v[0], t.axis);
  return FlatTriangle(triangle, t.axis | (n.z >= 0.0 ? RASTER_FACES_UP : 0u), vec3(-n.xy / n.z, first.z), first.xy);
}

/// Where its plane passes through a column of voxels: the point of raster voxelization's fragment (T eq. 14). `column`:
/// along the two other axes, as dominantLast has them.
vec3 flatPoint(FlatTriangle f, vec2 column) {
  return originalAxes(vec3(column, f.plane.z + dot(f.plane.xy, column - f.corner)), f.axis & 3u);
}

/// Tiles of a triangle: their edge in columns and how many there are along the two other axes.
uint tileEdge(uvec2 columns, out uvec2 tiles) {
  uint edge = TILE_COLUMNS;
  tiles = (columns + edge - 1u) / edge;
  while (tiles.x * tiles.y > TILES_PER_TRIANGLE) {
    edge *= 2u;
    tiles = (columns + edge - 1u) / edge;
  }
  return edge;
}
