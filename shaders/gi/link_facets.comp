// Which facets of the voxels around continue a facet's surface on the same side (docs/method.md 4): their normals are
// alike, and from the nearest surfel of the one to that of the other nothing is in between. One invocation per facet and
// four voxels around.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "gi/split_piece.glsl"
layout(local_size_x = 64) in;
layout(push_constant, scalar) uniform Push { LinkFacetsPush push; };

uint entryAt(ivec3 v) {
  if (any(lessThan(v, ivec3(0))) || any(greaterThanEqual(v, ivec3(push.dims)))) return NO_FACET;
  return push.reverse.at[voxelIndex(uvec3(v), push.dims)];
}

/// Whether the segment crosses no triangle but two, in any of the voxels that it passes.
bool clearBetween(SurfaceArrays surface, vec3 a, vec3 b, uint except1, uint except2) {
  ivec3 lo = ivec3(floor(min(a, b))), hi = ivec3(floor(max(a, b)));
  for (int z = lo.z; z <= hi.z; ++z)
    for (int y = lo.y; y <= hi.y; ++y)
      for (int x = lo.x; x <= hi.x; ++x) {
        uint entry = entryAt(ivec3(x, y, z));
        if (entry != NO_FACET && !clearInVoxel(piecesOf(surface, entry), a, b, except1, except2)) return false;
      }
  return true;
}

/// sameSide() across voxels.
bool continues(SurfaceArrays surface, SurfelPoint a, SurfelPoint b) {
  float lift;
  if (!mayBeSameSide(a.position, a.facing, b.position, b.facing, lift)) return false;
  vec3 from = a.position + a.facing * lift, to = b.position + b.facing * lift;
  if (lift > 2.0 * ABOVE_SURFACE &&
      !(clearBetween(surface, a.position + a.facing * ABOVE_SURFACE, from, a.triangle, b.triangle) &&
        clearBetween(surface, b.position + b.facing * ABOVE_SURFACE, to, a.triangle, b.triangle)))
    return false;
  return clearBetween(surface, from, to, a.triangle, b.triangle);
}

void main() {
  uint index = irad_index();
  if (index >= push.count * FACET_LINKS) return;
  uint facet = index / FACET_LINKS, part = index % FACET_LINKS;
  SurfaceArrays surface = push.surface.at[0];
  ivec3 voxel = ivec3(unpackVoxel(push.voxel.at[facet]));
  uint word = 0u;
  for (uint j = 0u; j < 4u; ++j) {
    uint i = 4u * part + j;
    uint link = NO_LINK;
    uint entry = i < 27u ? entryAt(voxel + ivec3(i % 3u, (i / 3u) % 3u, i / 9u) - 1) : NO_FACET;
    if (i == 13u) {
      link = facet - firstFacet(entry);
    } else if (entry != NO_FACET) {
      float best = 1e30;
      for (uint k = 0u; k < facetsOf(entry); ++k) {
        uint other = firstFacet(entry) + k;
        float nearest = 1e30;
        SurfelPoint from, to;
        for (uint m = 0u; m < FACET_SURFELS; ++m) {
          SurfelPoint a = surfelOf(surface, facet, m);
          for (uint n = 0u; n < FACET_SURFELS; ++n) {
            SurfelPoint b = surfelOf(surface, other, n);
            vec3 d = a.position - b.position;
            float distance2 = dot(d, d);
            if (distance2 >= nearest) continue;
            nearest = distance2;
            from = a;
            to = b;
          }
        }
        if (nearest >= best || !continues(surface, from, to)) continue;
        best = nearest;
        link = k;
      }
    }
    word |= link << (8u * j);
  }
  push.links.at[index] = word;
}
