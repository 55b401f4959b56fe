// Pieces with others standing on them: which facet a point of such a piece belongs to. The planes of the triangles that
// stand on it cut a piece into parts, and nothing stands between two points of one part (docs/method.md 4).
#ifndef IRAD_PIECE_CUTS_H
#define IRAD_PIECE_CUTS_H
#include "gi/triangle_hit.h"
#include "shared/surface.h"
IRAD_BEGIN

IRAD_CONST uint NO_PART = 0xFFFFu;

/// The part of a piece, cut by `count` triangles from `place` on in `cuts`, at a point; or NO_PART.
IRAD_FN uint partAt(Vec4Array corners, UintArray cuts, uint place, uint count, vec3 at) {
  uint part = 0u;
  for (uint i = 0u; i < count; ++i) {
    Triangle t = triangleAt(corners, cuts.at[place + i]);
    float side = dot(facingOf(t, false), at - t.a);
    if (abs(side) < CUT_WIDTH) return NO_PART;
    part |= side > 0.0f ? 1u << i : 0u;
  }
  return part;
}

struct PieceCuts {
  uint count;             ///< triangles that stand on the piece
  uint triangles, parts;  ///< places in `cuts`
  uint endParts;
};

IRAD_FN PieceCuts cutsOf(UintArray cuts, uint sides) {
  uint place = sides & ~PIECE_CUT;
  uint word = cuts.at[place], count = cutTriangles(word);
  uint triangles = place + cutHead(word);
  PieceCuts cuts_ = {count, triangles, triangles + count, triangles + count + cutParts(word)};
  return cuts_;
}

/// Whether a piece with a mask is there at a point relative to its voxel's lower corner.
IRAD_FN bool isThere(SurfaceArrays surface, uint piece, vec3 normal, vec3 point) {
  uint bit = maskBit(normal, point);
  uint place = (surface.sides.at[piece] & ~PIECE_CUT) + 1u + bit / 32u;
  return ((surface.cuts.at[place] >> (bit % 32u)) & 1u) != 0u;
}

/// The channels that a pane which tints keeps off at such a point, as bits.
IRAD_FN uint closedAt(SurfaceArrays surface, uint piece, vec3 normal, vec3 point) {
  uint bit = maskBit(normal, point), closed = 0u;
  uint place = (surface.sides.at[piece] & ~PIECE_CUT) + 3u + bit / 32u;
  for (uint c = 0u; c < 3u; ++c) closed |= ((surface.cuts.at[place + 2u * c] >> (bit % 32u)) & 1u) << c;
  return closed;
}

/// Which facet of its voxel, counted from the first, a point of a piece's side belongs to; or PIECE_*.
IRAD_FN uint classAt(SurfaceArrays surface, uint piece, bool back, vec3 at) {
  uint sides = surface.sides.at[piece];
  uint shift = back ? 8u : 0u;
  if ((sides & PIECE_CUT) == 0u) return (sides >> shift) & 0xFFu;
  PieceCuts cuts = cutsOf(surface.cuts, sides);
  uint part = partAt(surface.corners, surface.cuts, cuts.triangles, cuts.count, at);
  for (uint i = cuts.parts; i < cuts.endParts && part != NO_PART; ++i) {
    uint known = surface.cuts.at[i];
    if ((known >> 16) == part) return (known >> shift) & 0xFFu;
  }
  return PIECE_UNKNOWN;
}

IRAD_END
#endif
