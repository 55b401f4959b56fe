#version 460
#extension GL_GOOGLE_include_directive : require
// Squares of the B that a facet's rays bring, for the second moment F B^2 (docs/method.md 7).
#include "shared/solve.h"

layout(local_size_x = 64) in;
layout(push_constant, scalar) uniform Push { LightSquaresPush p; };

void main() {
  uint facet = irad_index();
  FacetArrays f = p.facets.at[0];
  if (facet >= f.count) return;
  vec3 light = p.radiosity.at[facet].xyz;
  if (p.emissionGain != 0.0f) light -= p.emissionGain * f.emission.at[facet];
  p.output_.at[facet] = vec4(light * light, 0.0f);
}
