// "GI Gather" where facets are pieces of the true surface (docs/method.md 6): direct irradiance D of every facet, averaged
// over its surfels, each of which sees the lights past the triangles themselves. What is behind them has exactly none. A
// light's points (GpuLight::points) are shared out among the surfels, each of which looks at some of every radius.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "shared/sampling.h"
#include "shared/solve.h"
#define IRAD_LIGHT_CONSTANTS GATHER_LIGHTS
#include "forward/light.glsl"
#include "gi/seen_point.glsl"

layout(local_size_x = 64) in;
layout(push_constant, scalar) uniform Push { GatherSurfelsPush p; };

shared vec3 ofSurfel[gl_WorkGroupSize.x];

/// Irradiance of the lights that a surfel sees.
vec3 gathered(uint facet, uint surfel) {
  SurfaceArrays surface = p.surface.at[0];
  TraceWorld world = TraceWorld(p.facets, p.chebyshev, p.dims, 0.0f);
  GpuScene scene = p.scene.at[0];
  uvec2 shift = uvec2(hashUint(facet), hashUint(~facet));
  SurfelPoint from = liftedSurfel(surface, facet, surfel);
  vec3 position = p.origin + p.edge * from.position;
  vec3 sum = vec3(0.0f);
  for (uint i = 0u; anyLight() && i < scene.lightCount; ++i) {
    GpuLight light = scene.lights.at[i];
    vec3 irradiance = lightIrradiance(light, position, from.facing);
    if (irradiance == vec3(0.0f)) continue;
    vec3 share = lightShare(world, surface, from, light, position, p.edge, surfel, FACET_SURFELS, pointsForSurfels(light), shift);
    if (share != vec3(0.0f)) sum += irradiance * share;
  }
  return sum;
}

// An invocation for each surfel: Mesa's CPU driver ends loops after 65,535 rounds of an invocation, which the rays of a
// whole facet may take together.
void main() {
  uint facet = irad_index() / FACET_SURFELS, surfel = irad_index() % FACET_SURFELS;
  uint at = gl_LocalInvocationIndex;
  ofSurfel[at] = facet < p.facets.count ? gathered(facet, surfel) : vec3(0.0f);
  barrier();
  if (surfel != 0u || facet >= p.facets.count) return;
  vec3 sum = vec3(0.0f);
  for (uint k = 0u; k < FACET_SURFELS; ++k) sum += ofSurfel[at + k];
  p.direct.at[facet] = vec4(sum / float(FACET_SURFELS), 0.0f);
}
