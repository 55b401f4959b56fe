// A facet's area, and its surfels: points of its pieces that stand for equal shares of it.
#ifndef IRAD_FACET_SURFELS_H
#define IRAD_FACET_SURFELS_H
#include "gi/facet_points.h"
#include "gi/piece_place.h"
#include "shared/grid.h"
IRAD_BEGIN

/// Points that are looked at in a round of a loop, of which Mesa's CPU driver allows an invocation 65,535: a voxel full of
/// foliage has more points than that.
IRAD_CONST uint AT_ONCE = 16u;

/// Of AT_ONCE points from `i` on those that are the facet's, a bit for each.
IRAD_FN uint ownPoints(UintArray classes, FacetPoints points, uint i) {
  uint own = 0u;
  IRAD_UNROLL for (uint j = 0u; j < AT_ONCE; ++j) {
    uint class_ = classes.at[min(i + j, points.end - 1u)] & ~CLASS_LEADER;
    own |= i + j < points.end && class_ == points.own ? 1u << j : 0u;
  }
  return own;
}

/// Writes on which sides its surfels are: 16 bits each, or 8 where that is enough for all that the voxel has.
IRAD_FN void putSides(FacetSurfelsPush push, uint facet, uvec4 sides, uint firstPiece, uint endPiece, uint class_) {
  uint at = SURFEL_WORDS * facet + FACET_SURFELS;
  if (endPiece - firstPiece > MOST_NARROW) {
    uint place = push.wideStart.at[push.pieceVoxel.at[firstPiece]] + class_;
    push.surfels.at[at] = place;
    push.surfels.at[at + 1u] = WIDE_SIDES;
    IRAD_UNROLL for (uint i = 0u; i < WIDE_WORDS; ++i) push.wideSides.at[WIDE_WORDS * place + i] = sides[i];
  } else {
    uvec4 bytes = (sides & 0xFFu) | ((sides >> 8u) & 0xFF00u);
    push.surfels.at[at] = bytes.x | (bytes.y << 16);
    push.surfels.at[at + 1u] = bytes.z | (bytes.w << 16);
  }
}

IRAD_FN void placeSurfels(FacetSurfelsPush push, SurfaceArrays surface, uint facet) {
  uint packedVoxel = push.voxel.at[facet];
  uvec3 voxel = unpackVoxel(packedVoxel);
  vec3 cell = vec3(voxel);
  uint entry = push.reverse.at[voxelIndex(voxel, push.dims)];
  FacetPoints points = pointsOf(surface, push.firstPoint, facet, entry);
  uint firstPiece = surface.firstPiece.at[facet];
  float area = 0.0f;
  for (uint i = points.first; i < points.end; i += AT_ONCE)
    for (uint own = ownPoints(push.classes, points, i); own != 0u; own &= own - 1u)
      area += push.pointArea.at[i + uint(findLSB(own))];
  push.area.at[facet] = area;

  uint shift = hashUint(packedVoxel ^ 0x2545F491u);
  uint k = 0u, side = 0u, place = 0u;
  uvec4 sides = uvec4(0u);  // two a word
  float upTo = 0.0f;
  uint next = points.first, own = 0u;
  while (k < FACET_SURFELS && (own != 0u || next < points.end)) {
    if (own == 0u) {
      own = ownPoints(push.classes, points, next);
      next += AT_ONCE;
    }
    if (own == 0u) continue;
    uint i = next - AT_ONCE + uint(findLSB(own));
    own &= own - 1u;
    PiecePoint p = push.points.at[i];
    float before = upTo, share = push.pointArea.at[i];
    upTo += share;
    // The last one takes what rounding leaves.
    float at = (float(k) + 0.5f) / float(FACET_SURFELS) * area;
    bool last = upTo >= area * 0.999999f;
    if (at >= upTo && !last) continue;
    uint piece = p.side & ~SURFEL_BACK;
    side = pieceSide(piece - firstPiece, (p.side & SURFEL_BACK) != 0u);
    uint triangle = triangleOf(surface.pieces, piece);
    Triangle t = triangleAt(surface.corners, triangle);
    uint axis = seenAlong(cross(t.b - t.a, t.c - t.a));
    if (k <= FACET_SURFELS / 2u) push.facings.at[facet] = facingOf(t, (p.side & SURFEL_BACK) != 0u);
    bool whole = (surface.sides.at[piece] & PIECE_CUT) == 0u;
    uint from = 0u, n = 0u;
    if (whole) n = clipPolygon(t.a - cell, t.b - cell, t.c - cell, 0.0f, from);
    while (k < FACET_SURFELS && (at < upTo || last)) {
      vec3 point = p.position;
      if (whole && n > 0u)
        point = cell + polygonPoint(from, n, share,
                                    vec2(clamp((at - before) / share, 0.0f, 1.0f), unitFloat(reverseBits(k) + shift)));
      place = packPlace(seenAt(point - cell, axis));
      push.surfels.at[SURFEL_WORDS * facet + k] = place;
      sides[k / 2u] |= side << (16u * (k % 2u));
      ++k;
      at = (float(k) + 0.5f) / float(FACET_SURFELS) * area;
    }
  }
  // Where Mesa's CPU driver has cut the loops short in a crowd, the last one stands for the others.
  IRAD_UNROLL for (uint i = 0u; i < FACET_SURFELS; ++i) {
    if (i >= k) {
      push.surfels.at[SURFEL_WORDS * facet + i] = place;
      sides[i / 2u] |= side << (16u * (i % 2u));
    }
  }
  putSides(push, facet, sides, firstPiece, surface.firstPiece.at[firstFacet(entry) + facetsOf(entry)], points.own);
}

IRAD_END
#endif
