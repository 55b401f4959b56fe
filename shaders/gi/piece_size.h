// Which pieces of a voxel are its largest, for those who sort them: gi/sort_pieces.comp and, on CPU devices,
// gi/surface_on_host.cpp.
#ifndef IRAD_PIECE_SIZE_H
#define IRAD_PIECE_SIZE_H
#include "gi/triangle_hit.h"
#include "gi/voxel_clip.h"
IRAD_BEGIN
#ifdef __cplusplus
using glm::floatBitsToUint;
#endif

/// Sizes by powers of two and one and a half times these, the largest first.
IRAD_CONST uint PIECE_SIZES = 64u;

/// Of a triangle's part in a cell. By the area's exponent and its first bit: drivers' logarithms round as they like.
IRAD_FN uint pieceSize(Vec4Array corners, vec3 cell, uint triangle) {
  Triangle t = triangleAt(corners, triangle);
  vec3 centre;
  float area = clipToCell(t.a - cell, t.b - cell, t.c - cell, centre);
  const uint OF_TWO = 256u;
  return area > 0.0f ? min(OF_TWO - min(floatBitsToUint(area) >> 22, OF_TWO), PIECE_SIZES - 1u) : PIECE_SIZES - 1u;
}

IRAD_END
#endif
