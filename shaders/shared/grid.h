// The voxel grid (docs/method.md 2, T 5.1.1): one edge length for every axis, one empty voxel of padding per side,
// half-open cells. Everything after voxelization works in voxel units: p_v = (p_local - origin) / edge.
#ifndef IRAD_SHARED_GRID_H
#define IRAD_SHARED_GRID_H
#include "shared/types.h"
IRAD_BEGIN

struct Grid {
  uvec3 dims;        ///< voxels per axis, padding included; each <= 1024
  float edge;        ///< world length of a voxel edge
  vec3 origin;       ///< local position of the grid's lower corner
  float inverseEdge;
  uvec3 mortonBits;  ///< bits per axis of the (compact) Morton code
  uint voxels;       ///< dims.x * dims.y * dims.z
};
IRAD_ARRAY(GridArray, Grid, 16)

/// Linear index, x fastest.
IRAD_FN uint voxelIndex(uvec3 v, uvec3 dims) { return v.x + dims.x * (v.y + dims.y * v.z); }
IRAD_FN uvec3 voxelOf(uint index, uvec3 dims) {
  return uvec3(index % dims.x, (index / dims.x) % dims.y, index / (dims.x * dims.y));
}

/// A voxel's coordinates in one word: 10 bits per axis.
IRAD_FN uint packVoxel(uvec3 v) { return v.x | (v.y << 10) | (v.z << 20); }
IRAD_FN uvec3 unpackVoxel(uint p) { return uvec3(p & 1023u, (p >> 10) & 1023u, (p >> 20) & 1023u); }

/// Compact Morton code: bits of x, y, z interleaved from the lowest, each axis only as long as it has bits, so that the
/// code's range is the product of the axes' power-of-two sizes. Returns the voxel of a code.
IRAD_FN uvec3 mortonDecode(uint code, uvec3 bits) {
  uvec3 v = uvec3(0u);
  uint shift = 0u;
  for (uint level = 0u; level < 10u; ++level) {
    if (level < bits.x) v.x |= ((code >> shift++) & 1u) << level;
    if (level < bits.y) v.y |= ((code >> shift++) & 1u) << level;
    if (level < bits.z) v.z |= ((code >> shift++) & 1u) << level;
  }
  return v;
}

IRAD_END
#endif
