// Points by which the facets of a voxel are told apart, for those who find their classes: gi/class_points.comp,
// gi/class_crowd.comp and, on CPU devices, gi/surface_on_host.cpp.
#ifndef IRAD_CLASS_POINT_H
#define IRAD_CLASS_POINT_H
#include "gi/seen_in_voxel.h"
IRAD_BEGIN

IRAD_CONST float LEAST_FACET = 1e-4f;  ///< voxel faces: pieces with less are no facet of their own

struct ClassPoint {
  SidePoint point;
  float area;  ///< of the piece
};

IRAD_FN ClassPoint classPoint(ClassPointsPush from, SurfaceArrays surface, uint i) {
  PiecePoint p = from.points.at[i];
  uint piece = p.side & ~SURFEL_BACK;
  vec3 front = from.facings.at[piece];
  ClassPoint point;
  point.point.at.position = p.position;
  point.point.at.facing = (p.side & SURFEL_BACK) != 0u ? -front : front;
  point.point.at.triangle = triangleOf(surface.pieces, piece);
  point.point.lift = p.lift;
  point.area = from.area.at[piece];
  return point;
}

/// The pieces of a solid voxel, counted from the first one.
IRAD_FN VoxelPieces piecesOfSolid(ClassPointsPush from, SurfaceArrays surface, uint voxel) {
  return voxelPieces(surface.corners, surface.pieces, surface.boxes, vec3(unpackVoxel(from.solid.at[voxel])),
                     from.firstPiece.at[voxel], from.firstPiece.at[voxel + 1u]);
}

IRAD_END
#endif
