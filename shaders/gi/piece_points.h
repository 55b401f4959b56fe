// The points of a piece by which the facets of its voxel are told apart: the middle of a whole piece; of one that others
// stand on several, and those triangles.
#ifndef IRAD_PIECE_POINTS_H
#define IRAD_PIECE_POINTS_H
#include "gi/piece_cuts.h"
#include "gi/piece_place.h"
#include "gi/seen_in_voxel.h"
IRAD_BEGIN

IRAD_FN void findPoints(PiecePointsPush push, SurfaceArrays surface, uint piece) {
  uint voxel = push.pieceVoxel.at[piece];
  vec3 cell = vec3(unpackVoxel(push.solid.at[voxel]));
  uint triangle = triangleOf(surface.pieces, piece);
  Triangle t = triangleAt(surface.corners, triangle);
  uint place = push.firstPoint.at[piece];
  bool back = showsBack(surface.corners, triangle);
  uint cut = push.firstCut.at[piece];
  uint count = push.firstCut.at[piece + 1u] - cut;
  uint from;
  uint n = clipPolygon(t.a - cell, t.b - cell, t.c - cell, 0.0f, from);
  vec3 facing = facingOf(t, false);
  VoxelPieces others =
      voxelPieces(surface.corners, surface.pieces, surface.boxes, cell, push.firstPiece.at[voxel], push.firstPiece.at[voxel + 1u]);
  push.sides.at[piece] = count == 0u ? 0u : PIECE_CUT | cut;
  if (count == 0u) {
    vec3 middle = (t.a + t.b + t.c) * (1.0f / 3.0f) - cell;
    if (n > 0u) polygonArea(from, n, middle);
    middle += cell;
    for (uint side = 0u; side < (back ? 2u : 1u); ++side) {
      float lift = clearAbove(others, middle, side == 0u ? facing : -facing, triangle);
      PiecePoint point = {middle, piece | (side == 0u ? 0u : SURFEL_BACK), lift};
      push.points.at[place + side] = point;
      push.classes.at[place + side] = NO_CLASS;
    }
    return;
  }

  bool mask = hasHoles(surface.corners, triangle);
  // Where anything is there of a screen its points stand for all of it: they may all fall between the squares.
  uint kind = mask ? surface.cuts.at[cut] & (CUT_MASKED | CUT_SCREEN | CUT_TINTED) : 0u;
  bool screen = (kind & CUT_SCREEN) != 0u && (surface.cuts.at[cut + 1u] | surface.cuts.at[cut + 2u]) != 0u;
  uint triangles = cut + cutHead(kind);
  uint found = 0u;  // as many as gi/piece_shape.comp has made room for
  for (uint may = mayStandOn(others, piece, t, back);
       may != 0u && triangles + found + 1u + mostParts(found + 1u) <= cut + count; may &= may - 1u) {
    uint other = surface.pieces.at[others.first + uint(findLSB(may))];
    if (standsOnSides(cell, triangleAt(surface.corners, other), t, back)) push.cuts.at[triangles + found++] = other;
  }
  uint parts = triangles + found, endParts = parts;
  for (uint k = 0u; k < CUT_POINTS; ++k) {
    vec3 at;
    uint part = NO_PART;
    for (uint again = 0u; again < 4u && part == NO_PART; ++again) {
      at = cell + polygonPoint(from, n, push.area.at[piece], cutPlace(piece, k, again));
      part = partAt(surface.corners, push.cuts, triangles, found, at);
    }
    if (mask && !screen && !isThere(surface, piece, facing, at - cell)) part = NO_PART;
    // Nothing is between two points of one part: one is enough, which is left there for the part's facets.
    uint first = part == NO_PART ? CUT_POINTS : k;
    for (uint j = parts; j < endParts && first == k; ++j)
      if (push.cuts.at[j] >> 16 == part) first = push.cuts.at[j] & 0xFFFFu;
    if (first == k && endParts < cut + count) push.cuts.at[endParts++] = (part << 16) | k;
    for (uint side = 0u; side < (back ? 2u : 1u); ++side) {
      uint i = place + side * CUT_POINTS + k;
      float lift = first == k ? clearAbove(others, at, side == 0u ? facing : -facing, triangle) : 0.0f;
      PiecePoint point = {at, piece | (side == 0u ? 0u : SURFEL_BACK), lift};
      push.points.at[i] = point;
      push.classes.at[i] = first == k ? NO_CLASS : CLASS_OF_PART | first;
    }
  }
  push.cuts.at[cut] = cutCounts(found, endParts - parts) | kind;
}

IRAD_END
#endif
