#version 460
#extension GL_GOOGLE_include_directive : require
// The facets' exitance M as a vector that the matrix can be applied to.
#include "shared/solve.h"

layout(local_size_x = 64) in;
layout(push_constant, scalar) uniform Push { EmissionPush p; };

void main() {
  uint facet = irad_index();
  FacetArrays f = p.facets.at[0];
  if (facet < f.count) p.output_.at[facet] = vec4(f.emission.at[facet], 0.0f);
}
