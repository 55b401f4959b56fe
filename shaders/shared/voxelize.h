// Push constants and keys of voxelization, compaction and distance fields (METHOD sections 2-4).
#ifndef IRAD_SHARED_VOXELIZE_H
#define IRAD_SHARED_VOXELIZE_H
#include "shared/facets.h"
#include "shared/grid.h"
#include "shared/scene_gpu.h"
IRAD_BEGIN

/// Ordered key of a triangle in a voxel, resolved by atomicMax: bits 27-31 the area inside the voxel, up to half a face
/// (more counts the same); bits 24-26 how far in front it lies along its own facing; bits 0-23 the triangle's
/// complement, so that equals go to the lower triangle. Of two faces that both fill a voxel, such as a lamp just below
/// a ceiling, the visible one wins; a sliver of the front one does not. 0 is empty: the lower bits are never 0. `area`:
/// voxel faces, [0, sqrt 2]; `front`: (centre of the part - centre of the voxel) . unit facing, voxels.
IRAD_CONST uint MAX_TRIANGLES = 0xFFFFFEu;
IRAD_FN uint voxelKey(float area, float front, uint triangle) {
  float a = floor(area * 62.0f + 0.5f);
  float f = floor((front + 0.875f) * (8.0f / 1.75f));
  f = f < 0.0f ? 0.0f : (f > 7.0f ? 7.0f : f);
  return (uint(a < 31.0f ? a : 31.0f) << 27) | (uint(f) << 24) | (0xFFFFFFu - triangle);
}
IRAD_FN uint keyTriangle(uint key) {
  return 0xFFFFFFu - (key & 0xFFFFFFu);
}

/// The second facet of a voxel faces against the first: n . n' below this. Perpendicular walls (a corner) are not
/// opposed.
IRAD_CONST float OPPOSED_COSINE = -0.25f;

/// Conservative voxelization: a triangle's columns (along its dominant axis) are cut into tiles of (4 << level)^2,
/// level the least for which this many tiles suffice. MAX_TRIANGLES x this < 2^32, so that the prefix sum cannot wrap.
IRAD_CONST uint TILES_PER_TRIANGLE = 256u;
IRAD_CONST uint TILE_COLUMNS = 4u;

/// Raster voxelization: the triangle's normal points up its dominant axis; beside the axis (0, 1, 2).
IRAD_CONST uint RASTER_FACES_UP = 4u;

struct VoxelizePush {
  SceneArray scene;
  GridArray grid;
  UintArray keys;       ///< slots x voxels
  UintArray tileStart;  ///< per triangle: tiles, then their exclusive prefix sum
  uint firstTriangle;
  uint endTriangle;
  uint firstTile;
  uint tileCount;
  uint slot;  ///< 0: the best triangle of all; 1: the best that faces against it
};

struct CompactPush {
  GridArray grid;
  UintArray keys;
  UintArray blockCounts;  ///< facets per block of 4 x 4 x 4 voxels (64 Morton codes), then their exclusive prefix sum
  UintArray totals;       ///< [0] facets (from the prefix sum), [1] solid voxels
  UintArray voxel;
  UintArray triangle;  ///< winner | SECOND_FACET for the second facet of a voxel
  UintArray reverse;
  uint blocks;
  uint slots;
};

struct ShadeFacetsPush {
  SceneArray scene;
  GridArray grid;
  UintArray order;  ///< facets grouped by material; all that sample no texture are one group
  UintArray voxel;
  UintArray triangle;
  UintArray shape;
  Uvec2Array albedo;
  Vec3Array emission;
  UintArray clamped;  ///< [0]: facets whose albedo had to be clamped
  uint first;         ///< this group, within `order`
  uint count;
  uint encoding;
  uint hasEmission;
  uint literal;
};

struct ScanPush {
  UintArray values;
  UintArray total;
  uint count;   ///< elements of this level
  uint stride;  ///< of this level's elements within `values`
  uint last;    ///< 1: one block; its sum is the total
};
/// Elements that one workgroup scans.
IRAD_CONST uint SCAN_BLOCK = 2048u;

struct FieldPush {
  GridArray grid;
  UintArray reverse;
  UintArray source;
  UintArray target;
  uint step;  ///< chebyshev: the axis; jump flooding: the step in voxels
  float scale;
};
/// Jump flooding: no seed known yet.
IRAD_CONST uint NO_SEED = 0xFFFFFFFFu;

IRAD_END
#endif
