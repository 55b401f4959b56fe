// meanFacet() of every facet.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "gi/facet_mean.h"
layout(local_size_x = 64) in;
layout(push_constant, scalar) uniform Push { FacetMeanPush push; };

void main() {
  uint facet = irad_index();
  if (facet < push.count) meanFacet(push, push.surface.at[0], facet);
}
