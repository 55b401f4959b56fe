// Push constants and keys of voxelization, compaction and distance fields (docs/method.md 2-4).
#ifndef IRAD_SHARED_VOXELIZE_H
#define IRAD_SHARED_VOXELIZE_H
#include "shared/facets.h"
#include "shared/grid.h"
#include "shared/normals.h"
#include "shared/scene_gpu.h"
IRAD_BEGIN

/// Ordered key of a triangle in a voxel, resolved by atomicMax; 0 is empty. Bit 31: the triangle crosses the voxel's
/// middle line along the triangle's dominant axis, as exactly one triangle of a surface does, however finely it is
/// divided. Bits 25-30 where it does: `front`, the distance of the crossing's plane from the voxel's centre along the
/// triangle's facing, voxels, so that of a lamp just below a ceiling, or a curtain before a wall, the visible face
/// wins; where it does not: `area` inside the voxel, voxel faces, half a face being full, so that the largest of
/// slivers wins. Bits 0-23: the triangle's complement, so that equals go to the lower triangle.
IRAD_CONST uint MAX_TRIANGLES = 0xFFFFFEu;
IRAD_CONST uint KEY_MIDDLE = 1u << 31;
IRAD_FN uint keySteps(float steps) {
  return uint(steps < 0.0f ? 0.0f : (steps > 63.0f ? 63.0f : steps)) << 25;
}
IRAD_FN uint middleKey(float front, uint triangle) {
  return KEY_MIDDLE | keySteps(floor(front * 64.0f + 32.0f)) | (0xFFFFFFu - triangle);
}
IRAD_FN uint sliverKey(float area, uint triangle) {
  return keySteps(floor(area * 126.0f + 0.5f)) | (0xFFFFFFu - triangle);
}
IRAD_FN uint keyTriangle(uint key) {
  return 0xFFFFFFu - (key & 0xFFFFFFu);
}

/// Conservative voxelization: a triangle's columns (along its dominant axis) are cut into tiles of (4 << level)^2,
/// level the least for which this many tiles suffice. MAX_TRIANGLES x this < 2^32, so that the prefix sum cannot wrap.
IRAD_CONST uint TILES_PER_TRIANGLE = 256u;
IRAD_CONST uint TILE_COLUMNS = 4u;

/// Raster voxelization: the triangle's normal points up its dominant axis; beside the axis (0, 1, 2).
IRAD_CONST uint RASTER_FACES_UP = 4u;

struct VoxelizePush {
  SceneArray scene;
  GridArray grid;
  UintArray keys;       ///< per voxel
  UintArray tileStart;  ///< per triangle: tiles, then their exclusive prefix sum; by kernels the RasterQueue
  uint firstTriangle;
  uint endTriangle;
  uint firstTile;
  uint tileCount;  ///< by kernels the pieces that the RasterQueue holds
};

struct CompactPush {
  GridArray grid;
  UintArray keys;
  UintArray blockCounts;  ///< facets per block of 4 x 4 x 4 voxels (64 Morton codes), then their exclusive prefix sum
  UintArray voxel;
  UintArray triangle;  ///< the winner
  UintArray reverse;
  uint blocks, pad;
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
  FloatArray area;
  UintArray clamped;  ///< [0]: facets whose albedo had to be clamped
  uint first;         ///< this group, within `order`
  uint count;
  IRAD_AS(NormalEncoding) encoding;
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
