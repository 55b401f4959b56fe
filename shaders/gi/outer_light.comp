// "GI Gather" outside the grid (docs/method.md 6): of each point there, what lights bring it past the triangles of the
// whole scene, what comes straight from the sky and from emitters that are near (gi/outer_emitters.comp has left there
// what the others bring), and the radiance that follows. The directions are the same for all points, so that their noise
// is no pattern on a plane.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "shared/sampling.h"
#include "shared/solve.h"
#define IRAD_LIGHT_CONSTANTS GATHER_LIGHTS
#include "forward/light.glsl"
#include "gi/outer_point.glsl"

layout(local_size_x = 64) in;
layout(push_constant, scalar) uniform Push { OuterLightPush p; };

void main() {
  uint index = irad_index();
  if (index >= p.count) return;
  SurfaceArrays surface = p.surface.at[0];
  OuterArrays outer = surface.outer.at[0];
  TraceWorld world = TraceWorld(p.facets, p.chebyshev, p.dims, 0.0f);
  GpuScene scene = p.scene.at[0];
  OuterPoint point = outer.points.at[index];
  SurfelPoint from = liftedPoint(surface, outer, p.dims, point);
  vec3 position = p.origin + p.edge * from.position;
  vec3 direct = vec3(0.0f);
  for (uint i = 0u; anyLight() && i < scene.lightCount; ++i) {
    GpuLight light = scene.lights.at[i];
    vec3 irradiance = lightIrradiance(light, position, from.facing);
    if (irradiance == vec3(0.0f)) continue;
    direct += irradiance * lightShare(world, surface, from, light, position, p.edge, 0u, 1u, light.points, uvec2(0u));
  }
  vec3 sky = vec3(0.0f);
  for (uint k = 0u; k < OUTER_RAYS; ++k) {
    vec3 direction = toWorld(cosineDirection(hammersley(k, OUTER_RAYS, uvec2(0u))), from.facing);
    TraceHit hit = traceScene(world, surface, from.position, direction, from.triangle);
    vec3 open = letThrough(), exitance = vec3(0.0f);
    float sides = 1.0f;
    if (hit.facet == TRACE_ESCAPED) {
      sky += open * IRAD_PI * p.bins.at[skyBin(direction, SKY_EDGE)].xyz;
    } else if (isOuter(hit.facet)) {
      uint triangle = outer.points.at[hit.facet - metOuter(0u)].side & ~SURFEL_BACK;
      exitance = outer.exitance.at[triangle];
      sides = showsBack(surface.corners, triangle) ? 2.0f : 1.0f;
    } else if (hit.facet <= TRACE_LAST_FACET && p.facets.hasEmission != 0u) {
      exitance = p.facets.emission.at[hit.facet];
    }
    if (exitance != vec3(0.0f) && hit.t * hit.t < farFrom2(emitterDensity(exitance, sides, p.emitterPower)))
      sky += open * exitance;
  }
  sky = sky / float(OUTER_RAYS) + p.irradiance.at[index].xyz;
  p.irradiance.at[index] = vec4(sky, 0.0f);
  uint triangle = point.side & ~SURFEL_BACK;
  vec3 radiosity = outer.exitance.at[triangle] + outer.albedo.at[triangle] * (direct + sky);
  p.bins.at[SKY_BINS + index] = vec4(radiosity / IRAD_PI, 0.0f);
}
