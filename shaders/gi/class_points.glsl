// What the two kernels that find classes of points share.
#include "gi/seen_in_voxel.glsl"
layout(push_constant, scalar) uniform Push { ClassPointsPush push; };

const float LEAST_FACET = 1e-4;  ///< voxel faces: pieces with less are no facet of their own

struct ClassPoint {
  vec3 position, facing;
  uint triangle, side;
  float area;  ///< of the piece
};

ClassPoint classPoint(SurfaceArrays surface, uint i) {
  PiecePoint p = push.points.at[i];
  uint piece = p.side & ~SURFEL_BACK;
  uint triangle = triangleOf(surface.pieces, piece);
  return ClassPoint(p.position, facingOf(triangleAt(surface.corners, triangle), (p.side & SURFEL_BACK) != 0u),
                    triangle, p.side, push.area.at[piece]);
}

bool together(VoxelPieces pieces, ClassPoint a, ClassPoint b) {
  return sameSide(pieces, a.position, a.facing, a.triangle, b.position, b.facing, b.triangle);
}
