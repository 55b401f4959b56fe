// Which facets of the voxels around continue a facet's surface on the same side (docs/method.md 4): their normals are
// alike, and from the nearest surfel of the one to that of the other nothing is in between. One invocation per facet
// and four voxels around.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "gi/beside.glsl"
layout(local_size_x = 64) in;
layout(push_constant, scalar) uniform Push { LinkFacetsPush push; };

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
    ivec3 around = voxel + ivec3(i % 3u, (i / 3u) % 3u, i / 9u) - 1;
    uint entry = i < 27u ? entryOf(push.reverse, push.dims, around) : NO_FACET;
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
        if (nearest >= best || !continues(surface, push.reverse, push.dims, from, to)) continue;
        best = nearest;
        link = k;
      }
    }
    word |= link << (8u * j);
  }
  push.links.at[index] = word;
}
