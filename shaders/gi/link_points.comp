// Where each surfel lies and how far above it ways begin, for gi/link_facets.comp: every facet around asks for them.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "gi/beside.h"
layout(local_size_x = 64) in;
layout(push_constant, scalar) uniform Push { LinkPointsPush push; };

void main() {
  uint i = irad_index();
  if (i >= FACET_SURFELS * push.count) return;
  SurfaceArrays surface = push.surface.at[0];
  SurfelPoint p = surfelOf(surface, i / FACET_SURFELS, i % FACET_SURFELS);
  push.points.at[i] = vec4(p.position, liftOf(surface, push.reverse, push.dims, p));
}
