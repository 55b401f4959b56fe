// What the voxelizers' kernels ask of a triangle.
#include "gi/voxel_triangle.h"
#include "shared/voxelize.h"

uint triangleFlags(SceneArray scenes, uint triangle) {
  return scenes.at[0].materials.at[scenes.at[0].triangleMaterials.at[triangle]].flags;
}

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
