// Which facets of the voxels around continue a facet's surface on the same side (docs/method.md 4): one of the same
// triangle, where nothing stands on it; or their normals are alike, and from the nearest surfel of the one to that of
// the other nothing is in between. One invocation per facet and four voxels around.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "gi/beside.glsl"
layout(local_size_x = 64) in;
layout(push_constant, scalar) uniform Push { LinkFacetsPush push; };

const uint NOTHING_STANDS = 0xFFFFu;

/// The facet of a side of a triangle in a voxel, counted from the first; NO_LINK where others stand on it, or it is too
/// small to have one; NOTHING_STANDS where the triangle has no piece.
uint wholePiece(SurfaceArrays surface, ivec3 v, uint side) {
  uint entry = entryOf(push.reverse, push.dims, v);
  if (entry == NO_FACET) return NOTHING_STANDS;
  uint piece = pieceIn(piecesOf(surface, entry), side & ~SURFEL_BACK);
  if (piece == NO_PIECE) return NOTHING_STANDS;
  uint sides = surface.sides.at[piece];
  if ((sides & PIECE_CUT) != 0u) return NO_LINK;
  uint found = ((side & SURFEL_BACK) != 0u ? sides >> 8 : sides) & 0xFFu;
  return found < PIECE_UNKNOWN ? found : NO_LINK;
}

/// Of the 3 x 3 x 3 voxels around, the smallest block that holds the middle one and voxel `i`.
uint blockTo(uint i) {
  uint block = 0u;
  ivec3 step_ = ivec3(i % 3u, (i / 3u) % 3u, i / 9u) - 1;
  for (int corner = 0; corner < 8; ++corner) {
    ivec3 v = step_ * ivec3(corner & 1, (corner >> 1) & 1, corner >> 2) + 1;
    block |= 1u << (v.x + 3 * v.y + 9 * v.z);
  }
  return block;
}

void main() {
  uint facet = irad_index();
  if (facet >= push.count) return;
  SurfaceArrays surface = push.surface.at[0];
  ivec3 voxel = ivec3(unpackVoxel(push.voxel.at[facet]));
  uint own = facet - firstFacet(entryOf(push.reverse, push.dims, voxel));
  // A triangle goes on through a block of voxels, which is convex, if nothing stands on it in any of them.
  uint side = surface.surfels.at[FACET_SURFELS * facet + FACET_SURFELS / 2u].triangle;
  bool whole = wholePiece(surface, voxel, side) == own;
  uint stands = 0u;
  for (uint i = 0u; i < 27u && whole; ++i) {
    ivec3 around = voxel + ivec3(i % 3u, (i / 3u) % 3u, i / 9u) - 1;
    if (wholePiece(surface, around, side) == NO_LINK) stands |= 1u << i;
  }
  vec3 position[FACET_SURFELS];
  for (uint m = 0u; m < FACET_SURFELS; ++m) position[m] = surfelOf(surface, facet, m).position;

  uint word = 0u;
  for (uint i = 0u; i < 4u * FACET_LINKS; ++i) {
    uint link = NO_LINK;
    ivec3 around = voxel + ivec3(i % 3u, (i / 3u) % 3u, i / 9u) - 1;
    uint entry = i < 27u ? entryOf(push.reverse, push.dims, around) : NO_FACET;
    if (i == 13u) {
      link = own;
    } else if (entry != NO_FACET) {
      if (whole && (stands & blockTo(i)) == 0u) link = min(wholePiece(surface, around, side), NO_LINK);
      bool known = link != NO_LINK;
      float best = 1e30;
      for (uint k = 0u; k < facetsOf(entry) && !known; ++k) {
        uint other = firstFacet(entry) + k;
        float nearest = 1e30;
        uint from = 0u, to = 0u;
        for (uint n = 0u; n < FACET_SURFELS; ++n) {
          vec3 b = surfelOf(surface, other, n).position;
          for (uint m = 0u; m < FACET_SURFELS; ++m) {
            vec3 d = position[m] - b;
            float distance2 = dot(d, d);
            if (distance2 >= nearest) continue;
            nearest = distance2;
            from = m;
            to = n;
          }
        }
        if (nearest >= best || !continues(surface, push.reverse, push.dims, surfelOf(surface, facet, from),
                                          surfelOf(surface, other, to)))
          continue;
        best = nearest;
        link = k;
      }
    }
    word |= link << (8u * (i % 4u));
    if (i % 4u == 3u) {
      push.links.at[FACET_LINKS * facet + i / 4u] = word;
      word = 0u;
    }
  }
}
