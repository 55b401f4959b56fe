// "GI BuildMatrix", kernel 1 of the thesis's hit rule: one invocation per ray of a chunk of rows. Writes what each ray
// met.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "shared/constants.h"
#include "shared/trace.h"

layout(local_size_x = 64) in;
layout(constant_id = CONSTANT_JITTER) const uint JITTER = 1u;
layout(push_constant, scalar) uniform Push { TraceRaysPush p; };

#include "gi/trace.glsl"

void main() {
  uint ray = irad_index();
  if (ray >= p.rows * p.rays) return;
  uint row = p.firstRow + ray / p.rays;
  uint k = ray % p.rays;
  FacetArrays facets = p.facets;
  uint packedVoxel = facets.voxel.at[row];
  vec3 normal = decodeNormal(facets.shape.at[row] & 0xFFFFu, TRACE_NORMALS);
  uvec4 shifts = rayShifts(packedVoxel, p.seed, JITTER);
  vec3 direction = toWorld(cosineDirection(hammersley(k, p.rays, shifts.xy)), normal);
  vec3 origin = vec3(unpackVoxel(packedVoxel)) + 0.5f + normal;  // T 5.6: one voxel along the normal from the centre
  TraceWorld world = TraceWorld(facets, p.chebyshev, p.dims, p.jfaMax);
  p.hits.at[ray] = traceThesis(world, traceStart(origin, direction)).facet;
}
