// "GI BuildMatrix", kernel 1, where rays meet triangles: what the rays of a chunk of rows meet. Rays take 5 to 100 steps;
// so that a subgroup does not wait for its longest one, each invocation has several, and takes up the next as soon as
// enough of its neighbours have finished, too.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_KHR_shader_subgroup_ballot : require
#include "shared/trace.h"

layout(local_size_x = 64) in;
layout(push_constant, scalar) uniform Push { TraceRaysPush p; };

#include "gi/trace.glsl"

uint lanes(bool which) { return subgroupBallotBitCount(subgroupBallot(which)); }

void main() {
  // Neighbouring invocations have neighbouring rays, now and after each stride.
  uint ray = gl_LocalInvocationID.x + irad_workgroup() * (gl_WorkGroupSize.x * RAYS_IN_TURN);
  uint end = min(ray - gl_LocalInvocationID.x + gl_WorkGroupSize.x * RAYS_IN_TURN, p.rows * p.rays);
  SurfaceArrays surface = p.surface.at[0];
  TraceWorld world = TraceWorld(p.facets, p.chebyshev, p.dims, p.jfaMax);
  TriangleWalk walk;
  bool has = false, going = false;  // a ray; and one that has not met anything yet
  uint mine = 0u;
  for (;;) {
    uint idle = lanes(!going && (has || ray < end)), busy = lanes(going);
    if (idle + busy == 0u) break;
    if (!going && (busy == 0u || idle >= busy / RAYS_WAIT)) {
      if (has) p.hits.at[mine] = facetMet(surface, walk.hit, walk.at.origin, walk.at.direction).facet;
      has = false;
      if (ray < end) {
        uint row = p.firstRow + ray / p.rays, k = ray % p.rays;
        uint cast_ = facetRays(surface.area.at[row], p.rays);
        mine = ray;
        ray += gl_WorkGroupSize.x;
        has = going = k < cast_;
        if (has) {
          FacetRay r = facetRay(surface, row, p.facets.voxel.at[row], k, cast_, p.seed, p.jitter);
          walk = startTriangles(r.from.position, r.direction, r.from.triangle, 1e30f);
        } else {
          p.hits.at[mine] = TRACE_NOT_CAST;
        }
      }
    }
    for (uint i = 0u; i < RAYS_STEPS && going; ++i) going = stepTriangles(world, surface, walk);
  }
}
