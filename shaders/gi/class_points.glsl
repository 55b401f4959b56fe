// What the two kernels that find classes of points share.
#include "gi/seen_in_voxel.glsl"
layout(push_constant, scalar) uniform Push { ClassPointsPush push; };

const float LEAST_FACET = 1e-4;  ///< voxel faces: pieces with less are no facet of their own

struct ClassPoint {
  SidePoint point;
  float area;  ///< of the piece
};

ClassPoint classPoint(SurfaceArrays surface, uint i) {
  PiecePoint p = push.points.at[i];
  uint piece = p.side & ~SURFEL_BACK;
  uint triangle = triangleOf(surface.pieces, piece);
  vec3 front = push.facings.at[piece];
  vec3 facing = (p.side & SURFEL_BACK) != 0u ? -front : front;
  return ClassPoint(SidePoint(SurfelPoint(p.position, facing, triangle), p.lift), push.area.at[piece]);
}
