// "GI BuildMatrix", kernel 1, where rays meet triangles: one invocation per ray of a chunk of rows, or of those that waited
// when the others had ended. Writes what each ray met.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "shared/constants.h"
#include "shared/sky.h"
#include "shared/trace.h"

layout(local_size_x = WAITING_GROUP) in;
layout(constant_id = CONSTANT_SKY) const bool SKY = false;  ///< rays that escape are told by bins
layout(constant_id = CONSTANT_JITTER) const uint JITTER = 1u;
layout(constant_id = CONSTANT_RESUMES) const bool RESUMES = false;  ///< the rays of p.resumed
layout(push_constant, scalar) uniform Push { TraceRaysPush p; };

#include "gi/trace.glsl"
#include "gi/waiting_rays.glsl"

void main() {
  uint ray = irad_index();
  WaitingRay waited;
  if (RESUMES) {
    if (ray >= p.resumed.head.count) return;
    waited = p.resumed.at[ray];
    ray = waited.ray;
  } else if (ray >= p.rows * p.rays) {
    return;
  }
  uint row = p.firstRow + ray / p.rays, k = ray % p.rays;
  SurfaceArrays surface = p.surface.at[0];
  uint cast_ = facetRays(surface.area.at[row], p.rays);
  if (k >= cast_) {
    p.hits.at[ray] = TRACE_NOT_CAST;
    return;
  }
  FacetRay r = facetRay(surface, row, p.facets.voxel.at[row], k, cast_, p.seed, JITTER);
  TraceWorld world = TraceWorld(p.facets, p.chebyshev, p.dims, p.jfaMax);
  uint met;
  if (RESUMES || FEW_RAYS > 0u) {
    TriangleWalk w = startTriangles(world.dims, r.from.position, r.direction, r.from.triangle, 1e30f);
    if (RESUMES) takeUp(world, surface, waited, w);
    uint turns = 0u;
    bool mayWait = FEW_RAYS > 0u;
    while (stepTriangles(world, surface, w)) {
      if (!mayWait) continue;
      bool few = subgroupBallotBitCount(subgroupBallot(true)) <= FEW_RAYS;
      if (++turns < LEAST_TURNS || !few) continue;
      if (putOnList(p.waiting, p.mostWaiting, ray, w)) return;
      mayWait = false;
    }
    met = facetMet(surface, w.hit, r.from.position, r.direction).facet;
  } else {
    met = traceScene(world, surface, r.from.position, r.direction, r.from.triangle).facet;
  }
  if (SKY && met == TRACE_ESCAPED) met = metSky(r.direction);
  if (!SKY && isSky(met)) met = TRACE_ESCAPED;
  if (TINTED && closedChannels != 0u && p.tintShift != 0u) {
    if (met <= TRACE_LAST_FACET) met |= closedChannels << p.tintShift;
    else if (isSky(met)) met |= closedChannels << TINT_SHIFT_SKY;
  }
  p.hits.at[ray] = met;
}
