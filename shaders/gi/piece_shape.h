// The area and box of a piece, how many others stand on it, and how many points it needs to tell facets apart.
#ifndef IRAD_PIECE_SHAPE_H
#define IRAD_PIECE_SHAPE_H
#include "gi/seen_in_voxel.h"
#include "gi/voxel_clip.h"
IRAD_BEGIN

IRAD_FN void shapePiece(PieceShapePush push, uint piece) {
  uint voxel = push.pieceVoxel.at[piece];
  vec3 cell = vec3(unpackVoxel(push.solid.at[voxel]));
  uint triangle = triangleOf(push.pieces, piece);
  Triangle t = triangleAt(push.corners, triangle);
  uint from;
  uint n = clipPolygon(t.a - cell, t.b - cell, t.c - cell, 0.0f, from);
  vec3 centre, low = vec3(1.0f), high = vec3(0.0f);
  push.facings.at[piece] = facingOf(t, false);
  push.area.at[piece] = n > 0u ? polygonArea(from, n, centre) : 0.0f;
  for (uint i = 0u; i < n; ++i) {
    vec3 corner = clipCorner(from, i);
    low = min(low, corner);
    high = max(high, corner);
  }
  // Where rounding leaves nothing of it the voxel's list still has it.
  push.boxes.at[piece] = n > 0u ? packBox(low, high) : WHOLE_BOX;
  bool back = showsBack(push.corners, triangle);
  uint cuts = 0u;
  VoxelPieces others =
      voxelPieces(push.corners, push.pieces, push.boxes, cell, push.firstPiece.at[voxel], push.firstPiece.at[voxel + 1u]);
  for (uint may = mayStandOn(others, piece, t, back); may != 0u && cuts < MOST_CUTS; may &= may - 1u)
    if (standsOnSides(cell, triangleAt(push.corners, push.pieces.at[others.first + uint(findLSB(may))]), t, back)) ++cuts;
  uint maskWords = hasHoles(push.corners, triangle) ? (isTinted(push.corners, triangle) ? 8u : 2u) : 0u;
  bool cut = cuts > 0u || maskWords > 0u;
  push.points.at[piece] = (cut ? CUT_POINTS : 1u) * (back ? 2u : 1u);
  push.cuts.at[piece] = cut ? 1u + maskWords + cuts + mostParts(cuts) : 0u;
}

IRAD_END
#endif
