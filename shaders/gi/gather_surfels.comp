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

void main() {
  uint facet = irad_index();
  if (facet >= p.facets.count) return;
  SurfaceArrays surface = p.surface.at[0];
  TraceWorld world = TraceWorld(p.facets, p.chebyshev, p.dims, 0.0f);
  GpuScene scene = p.scene.at[0];
  uvec2 shift = uvec2(hashUint(facet), hashUint(~facet));
  vec3 sum = vec3(0.0f);
  for (uint k = 0u; k < FACET_SURFELS; ++k) {
    SurfelPoint from = liftedSurfel(surface, facet, k);
    vec3 position = p.origin + p.edge * from.position;
    for (uint i = 0u; anyLight() && i < scene.lightCount; ++i) {
      GpuLight light = scene.lights.at[i];
      vec3 irradiance = lightIrradiance(light, position, from.facing);
      if (irradiance == vec3(0.0f)) continue;
      uint points = (light.points + FACET_SURFELS - 1u) / FACET_SURFELS * FACET_SURFELS;
      float share = lightShare(world, surface, from, light, position, p.edge, k, FACET_SURFELS, points, shift);
      if (share > 0.0f) sum += irradiance * share;
    }
  }
  p.direct.at[facet] = vec4(sum / float(FACET_SURFELS), 0.0f);
}
