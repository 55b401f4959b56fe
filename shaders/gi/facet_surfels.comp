// Each facet's area, and its surfels: points of its pieces that stand for equal shares of it.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_EXT_control_flow_attributes : require
#include "gi/facet_points.glsl"
#include "gi/piece_place.h"
#include "shared/grid.h"
layout(local_size_x = 64) in;
layout(push_constant, scalar) uniform Push { FacetSurfelsPush push; };

/// Points that are looked at in a round of a loop, of which Mesa's CPU driver allows an invocation 65,535: a voxel full of
/// foliage has more points than that.
const uint AT_ONCE = 16u;

/// Of AT_ONCE points from `i` on those that are the facet's, a bit for each.
uint ownPoints(FacetPoints points, uint i) {
  uint own = 0u;
  [[unroll]] for (uint j = 0u; j < AT_ONCE; ++j) {
    uint class_ = push.classes.at[min(i + j, points.end - 1u)] & ~CLASS_LEADER;
    own |= i + j < points.end && class_ == points.own ? 1u << j : 0u;
  }
  return own;
}

/// Writes the facet's surfel k.
void putPlace(uint facet, uint k, uint place) { push.surfels.at[SURFEL_WORDS * facet + k] = place; }

/// Writes on which sides its surfels are: 16 bits each, or 8 where that is enough for all that the voxel has.
void putSides(uint facet, uvec4 sides, uint firstPiece, uint endPiece, uint class_) {
  uint at = SURFEL_WORDS * facet + FACET_SURFELS;
  if (endPiece - firstPiece > MOST_NARROW) {
    uint place = push.wideStart.at[push.pieceVoxel.at[firstPiece]] + class_;
    push.surfels.at[at] = place;
    push.surfels.at[at + 1u] = WIDE_SIDES;
    [[unroll]] for (uint i = 0u; i < WIDE_WORDS; ++i) push.wideSides.at[WIDE_WORDS * place + i] = sides[i];
  } else {
    uvec4 bytes = (sides & 0xFFu) | ((sides >> 8) & 0xFF00u);
    push.surfels.at[at] = bytes.x | (bytes.y << 16);
    push.surfels.at[at + 1u] = bytes.z | (bytes.w << 16);
  }
}

void main() {
  uint facet = irad_index();
  if (facet >= push.count) return;
  SurfaceArrays surface = push.surface.at[0];
  uint packedVoxel = push.voxel.at[facet];
  uvec3 voxel = unpackVoxel(packedVoxel);
  vec3 cell = vec3(voxel);
  uint entry = push.reverse.at[voxelIndex(voxel, push.dims)];
  FacetPoints points = pointsOf(surface, push.firstPoint, facet, entry);
  uint firstPiece = surface.firstPiece.at[facet];
  float area = 0.0;
  for (uint i = points.first; i < points.end; i += AT_ONCE)
    for (uint own = ownPoints(points, i); own != 0u; own &= own - 1u) area += push.pointArea.at[i + findLSB(own)];
  push.area.at[facet] = area;

  uint shift = hashUint(packedVoxel ^ 0x2545F491u);
  uint k = 0u, side = 0u, place = 0u;
  uvec4 sides = uvec4(0u);  // two a word
  float upTo = 0.0;
  uint next = points.first, own = 0u;
  while (k < FACET_SURFELS && (own != 0u || next < points.end)) {
    if (own == 0u) {
      own = ownPoints(points, next);
      next += AT_ONCE;
    }
    if (own == 0u) continue;
    uint i = next - AT_ONCE + findLSB(own);
    own &= own - 1u;
    PiecePoint p = push.points.at[i];
    float before = upTo, share = push.pointArea.at[i];
    upTo += share;
    // The last one takes what rounding leaves.
    float at = (float(k) + 0.5) / float(FACET_SURFELS) * area;
    bool last = upTo >= area * 0.999999;
    if (at >= upTo && !last) continue;
    uint piece = p.side & ~SURFEL_BACK;
    side = pieceSide(piece - firstPiece, (p.side & SURFEL_BACK) != 0u);
    uint triangle = triangleOf(surface.pieces, piece);
    Triangle t = triangleAt(surface.corners, triangle);
    uint axis = seenAlong(cross(t.b - t.a, t.c - t.a));
    if (k <= FACET_SURFELS / 2u) push.facings.at[facet] = facingOf(t, (p.side & SURFEL_BACK) != 0u);
    bool whole = (surface.sides.at[piece] & PIECE_CUT) == 0u;
    uint from = 0u, n = 0u;
    if (whole) n = clipPolygon(t.a - cell, t.b - cell, t.c - cell, 0.0, from);
    while (k < FACET_SURFELS && (at < upTo || last)) {
      vec3 point = p.position;
      if (whole && n > 0u)
        point = cell + polygonPoint(from, n, share,
                                    vec2(clamp((at - before) / share, 0.0, 1.0), unitFloat(reverseBits(k) + shift)));
      place = packPlace(seenAt(point - cell, axis));
      putPlace(facet, k, place);
      sides[k / 2u] |= side << (16u * (k % 2u));
      ++k;
      at = (float(k) + 0.5) / float(FACET_SURFELS) * area;
    }
  }
  // Where Mesa's CPU driver has cut the loops short in a crowd, the last one stands for the others.
  [[unroll]] for (uint i = 0u; i < FACET_SURFELS; ++i) {
    if (i >= k) {
      putPlace(facet, i, place);
      sides[i / 2u] |= side << (16u * (i % 2u));
    }
  }
  putSides(facet, sides, firstPiece, surface.firstPiece.at[firstFacet(entry) + facetsOf(entry)], points.own);
}
