// "GI BuildMatrix", kernel 1, where rays meet triangles: one invocation per ray of a chunk of rows. Writes what each ray
// met.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "shared/constants.h"
#include "shared/sky.h"
#include "shared/trace.h"

layout(local_size_x = 128) in;
layout(constant_id = CONSTANT_SKY) const bool SKY = false;  ///< rays that escape are told by bins
layout(push_constant, scalar) uniform Push { TraceRaysPush p; };

#include "gi/trace.glsl"

void main() {
  uint ray = irad_index();
  if (ray >= p.rows * p.rays) return;
  uint row = p.firstRow + ray / p.rays, k = ray % p.rays;
  SurfaceArrays surface = p.surface.at[0];
  uint cast_ = facetRays(surface.area.at[row], p.rays);
  if (k >= cast_) {
    p.hits.at[ray] = TRACE_NOT_CAST;
    return;
  }
  FacetRay r = facetRay(surface, row, p.facets.voxel.at[row], k, cast_, p.seed, p.jitter);
  TraceWorld world = TraceWorld(p.facets, p.chebyshev, p.dims, p.jfaMax);
  uint met = traceScene(world, surface, r.from.position, r.direction, r.from.triangle).facet;
  if (SKY && met == TRACE_ESCAPED) met = metSky(r.direction);
  if (!SKY && isSky(met)) met = TRACE_ESCAPED;
  if (TINTED && closedChannels != 0u && p.tintShift != 0u) {
    if (met <= TRACE_LAST_FACET) met |= closedChannels << p.tintShift;
    else if (isSky(met)) met |= closedChannels << TINT_SHIFT_SKY;
  }
  p.hits.at[ray] = met;
}
