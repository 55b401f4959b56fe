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

/// Whether a triangle goes on from one voxel to another: nothing stands on it in any voxel of the block between them,
/// which is convex.
bool goesOn(SurfaceArrays surface, ivec3 voxel, ivec3 step_, uint side) {
  for (int corner = 0; corner < 8; ++corner) {
    ivec3 part = ivec3(corner & 1, (corner >> 1) & 1, corner >> 2);
    if (all(equal(part * abs(step_), part)) && wholePiece(surface, voxel + part * step_, side) == NO_LINK) return false;
  }
  return true;
}

void main() {
  uint index = irad_index();
  if (index >= push.count * FACET_LINKS) return;
  uint facet = index / FACET_LINKS, i = index % FACET_LINKS;
  SurfaceArrays surface = push.surface.at[0];
  ivec3 voxel = ivec3(unpackVoxel(push.voxel.at[facet]));
  ivec3 step_ = ivec3(i % 3u, (i / 3u) % 3u, i / 9u) - 1;
  uint entry = i < 27u ? entryOf(push.reverse, push.dims, voxel + step_) : NO_FACET;
  uint own = facet - firstFacet(entryOf(push.reverse, push.dims, voxel));
  uint link = i == 13u ? own : NO_LINK;
  if (i != 13u && entry != NO_FACET) {
    uint side = surface.surfels.at[FACET_SURFELS * facet + FACET_SURFELS / 2u].triangle;
    if (wholePiece(surface, voxel, side) == own && goesOn(surface, voxel, step_, side))
      link = min(wholePiece(surface, voxel + step_, side), NO_LINK);
    bool known = link != NO_LINK;
    vec3 facing = triangleFacing(surface, side);
    vec3 position[FACET_SURFELS];
    if (!known)
      for (uint m = 0u; m < FACET_SURFELS; ++m) position[m] = surfelOf(surface, facet, m).position;
    float best = 1e30;
    for (uint k = 0u; k < facetsOf(entry) && !known; ++k) {
      uint other = firstFacet(entry) + k;
      uint otherSide = surface.surfels.at[FACET_SURFELS * other + FACET_SURFELS / 2u].triangle;
      if (dot(facing, triangleFacing(surface, otherSide)) < SAME_SIDE_COSINE) continue;
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
  push.links.at[index] = uint8_t(link);
}
