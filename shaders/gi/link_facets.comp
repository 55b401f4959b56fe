// Which facets of the voxels around continue a facet's surface on the same side (docs/method.md 4): one of the same
// triangle, where nothing stands on it; or their normals are alike, and from a surfel near the voxels' common border to
// the nearest one of the other nothing is in between. 32 invocations per facet, of which 27 take a voxel each.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "gi/beside.glsl"
layout(local_size_x = 32, local_size_y = 2) in;
layout(push_constant, scalar) uniform Push { LinkFacetsPush push; };

const uint NOTHING_STANDS = 0xFFFFu;
shared uint whole[2][27];
shared vec3 surfels[2][FACET_SURFELS];  ///< positions of the facet's own

/// The facet of a side of a triangle in a voxel, counted from the first; NO_LINK where others stand on it, or it is too
/// small to have one; NOTHING_STANDS where the triangle has no piece.
uint wholePiece(SurfaceArrays surface, uint entry, uint side) {
  if (entry == NO_FACET) return NOTHING_STANDS;
  uint piece = pieceIn(piecesOf(surface, entry), side & ~SURFEL_BACK);
  if (piece == NO_PIECE) return NOTHING_STANDS;
  uint sides = surface.sides.at[piece];
  if ((sides & PIECE_CUT) != 0u) return NO_LINK;
  uint found = ((side & SURFEL_BACK) != 0u ? sides >> 8 : sides) & 0xFFu;
  return found < PIECE_UNKNOWN ? found : NO_LINK;
}

/// The facet's surfel that is nearest to a point.
SurfelPoint ownSurfel(SurfaceArrays surface, uint facet, vec3 point) {
  uint nearest = 0u;
  float best = 1e30;
  for (uint k = 0u; k < FACET_SURFELS; ++k) {
    vec3 d = surfels[gl_LocalInvocationID.y][k] - point;
    if (dot(d, d) >= best) continue;
    best = dot(d, d);
    nearest = k;
  }
  return surfelOf(surface, facet, nearest);
}

/// Whether the facet's triangle goes on into the voxel at `step_`: nothing stands on it in any voxel of the block between
/// them, which is convex.
bool goesOn(ivec3 step_) {
  for (int corner = 0; corner < 8; ++corner) {
    ivec3 part = ivec3(corner & 1, (corner >> 1) & 1, corner >> 2);
    ivec3 at = part * step_ + 1;
    if (all(equal(part * abs(step_), part)) && whole[gl_LocalInvocationID.y][at.x + 3 * at.y + 9 * at.z] == NO_LINK)
      return false;
  }
  return true;
}

void main() {
  uint facet = 2u * irad_workgroup() + gl_LocalInvocationID.y;
  uint i = gl_LocalInvocationID.x;
  bool any = facet < push.count;
  SurfaceArrays surface = push.surface.at[0];
  ivec3 voxel = ivec3(0), step_ = ivec3(i % 3u, (i / 3u) % 3u, i / 9u) - 1;
  uint entry = NO_FACET, side = 0u;
  if (any) {
    voxel = ivec3(unpackVoxel(push.voxel.at[facet]));
    side = surface.surfels.at[FACET_SURFELS * facet + FACET_SURFELS / 2u].triangle;
    if (i < FACET_SURFELS) surfels[gl_LocalInvocationID.y][i] = surfelOf(surface, facet, i).position;
  }
  if (any && i < 27u) {
    entry = entryOf(push.reverse, push.dims, voxel + step_);
    whole[gl_LocalInvocationID.y][i] = wholePiece(surface, entry, side);
  }
  barrier();
  if (!any || i >= FACET_LINKS) return;
  uint link = NO_LINK;
  if (i == 13u) {
    link = facet - firstFacet(entry);
  } else if (entry != NO_FACET) {
    uint own = facet - firstFacet(entryOf(push.reverse, push.dims, voxel));
    if (whole[gl_LocalInvocationID.y][13] == own && goesOn(step_))
      link = min(whole[gl_LocalInvocationID.y][i], NO_LINK);
    bool known = link != NO_LINK;
    vec3 facing = triangleFacing(surface, side), border = vec3(voxel) + 0.5 + 0.5 * vec3(step_);
    SurfelPoint from;
    float best = 1e30, distance2;
    bool chosen = false;
    for (uint k = 0u; k < facetsOf(entry) && !known; ++k) {
      uint other = firstFacet(entry) + k;
      uint otherSide = surface.surfels.at[FACET_SURFELS * other + FACET_SURFELS / 2u].triangle;
      if (dot(facing, triangleFacing(surface, otherSide)) < SAME_SIDE_COSINE) continue;
      if (!chosen) from = ownSurfel(surface, facet, border);
      chosen = true;
      SurfelPoint to = nearestSurfel(surface, other, from.position, distance2);
      if (distance2 >= best || !continues(surface, push.reverse, push.dims, from, to)) continue;
      best = distance2;
      link = k;
    }
  }
  push.links.at[FACET_LINKS * facet + i] = uint8_t(link);
}
