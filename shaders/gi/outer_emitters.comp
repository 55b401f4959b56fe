// "GI Gather" outside the grid, first part (docs/method.md 6): what each point there gets from emitters that it is far
// from. A lamp is met by one direction in a hundred; places drawn on it in proportion to power are all seen. They are the
// same for all points, so that their noise is no pattern on a plane.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "shared/sampling.h"
#include "shared/solve.h"
#include "gi/outer_point.glsl"

layout(local_size_x = 64) in;
layout(push_constant, scalar) uniform Push { OuterEmittersPush p; };

/// A place on an emitter, or on both of its sides.
struct EmitterPlace {
  vec3 position, facing, exitance;
  float sides;
  bool there;
};

uint drawn(EmitterTable table, float share, float keep) {
  Emitter e = table.entries.at[min(uint(share * float(table.count)), table.count - 1u)];
  return keep < e.keep ? e.facet : e.other;
}

EmitterPlace onFacet(SurfaceArrays surface, uint facet, vec2 u) {
  SurfelPoint s = liftedSurfel(surface, facet, uint(u.x * float(FACET_SURFELS)));
  return EmitterPlace(s.position, s.facing, p.facets.emission.at[facet], 1.0f, true);
}

/// Within the grid it is a facet's.
EmitterPlace onTriangle(SurfaceArrays surface, uint triangle, vec2 u) {
  Triangle t = triangleAt(surface.corners, triangle);
  float s = sqrt(u.x);
  vec3 at = t.a + s * (1.0f - u.y) * (t.b - t.a) + s * u.y * (t.c - t.a);
  bool within = all(greaterThanEqual(at, vec3(0.0f))) && all(lessThan(at, vec3(p.dims)));
  return EmitterPlace(at, facingOf(t, false), surface.outer.at[0].exitance.at[triangle],
                      showsBack(surface.corners, triangle) ? 2.0f : 1.0f, !within);
}

void main() {
  uint index = irad_index();
  if (index >= p.count) return;
  SurfaceArrays surface = p.surface.at[0];
  OuterArrays outer = surface.outer.at[0];
  TraceWorld world = TraceWorld(p.facets, p.chebyshev, p.dims, 0.0f);
  SurfelPoint from = liftedPoint(surface, outer, p.dims, outer.points.at[index]);
  float inner = p.hasFacets != 0u ? p.byFacets.at[0].power : 0.0f, power = p.power;
  vec3 sum = vec3(0.0f);
  for (uint k = 0u; k < OUTER_RAYS; ++k) {
    float share = (float(k) + 0.5f) / float(OUTER_RAYS) * power, keep = unitFloat(reverseBits(k));
    vec2 u = facetJitter(k, uvec2(0u));
    EmitterPlace to;
    if (share < inner)
      to = onFacet(surface, drawn(p.byFacets.at[0], share / inner, keep), u);
    else
      to = onTriangle(surface, drawn(p.byTriangles.at[0], (share - inner) / (power - inner), keep), u);
    vec3 way = to.position - from.position;
    float reach = length(way), density = emitterDensity(to.exitance, to.sides, power);
    if (!to.there || reach * reach < farFrom2(density)) continue;
    vec3 direction = way / reach;
    float cosine = -dot(to.facing, direction);
    float cosines = max(dot(from.facing, direction), 0.0f) * (to.sides == 2.0f ? abs(cosine) : max(cosine, 0.0f));
    if (cosines == 0.0f || !reaches(world, surface, from, direction, reach)) continue;
    sum += to.exitance * letThrough() * (cosines / (IRAD_PI * reach * reach * density));
  }
  p.irradiance.at[index] = vec4(sum / float(OUTER_RAYS), 0.0f);
}
