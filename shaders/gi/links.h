// Where the surface of a facet goes on, for those who find its links: gi/link_facets.comp and, on CPU devices,
// gi/surface_on_host.cpp.
#ifndef IRAD_LINKS_H
#define IRAD_LINKS_H
#include "gi/beside.h"
IRAD_BEGIN

IRAD_CONST uint NOTHING_STANDS = 0xFFFFu;

/// The facet of a side of a triangle in a voxel, counted from the first; NO_LINK where others stand on it, or it is too
/// small to have one; NOTHING_STANDS where the triangle has no piece.
IRAD_FN uint wholePiece(SurfaceArrays surface, uint entry, uint side) {
  if (entry == NO_FACET) return NOTHING_STANDS;
  uint piece = pieceIn(piecesOf(surface, entry), side & ~SURFEL_BACK);
  if (piece == NO_PIECE) return NOTHING_STANDS;
  uint of = surface.sides.at[piece];
  if ((of & PIECE_CUT) != 0u) return NO_LINK;
  uint found = ((side & SURFEL_BACK) != 0u ? of >> 8 : of) & 0xFFu;
  return found < PIECE_UNKNOWN ? found : NO_LINK;
}

/// Of the block of voxels between a facet's own and that at `step_`, which is convex, the place among the 27 of the one at
/// one of its eight corners: some of these are the same.
IRAD_FN uint blockPlace(uint corner, ivec3 step_) {
  ivec3 at = ivec3(int(corner & 1u), int((corner >> 1) & 1u), int(corner >> 2)) * step_ + 1;
  return uint(at.x + 3 * at.y + 9 * at.z);
}

/// Where a way from a facet's voxel to that at `step_` crosses their common border, about: surfels near it are compared.
IRAD_FN vec3 borderTo(uint voxel, ivec3 step_) { return vec3(unpackVoxel(voxel)) + 0.5f + 0.5f * vec3(step_); }

IRAD_END
#endif
