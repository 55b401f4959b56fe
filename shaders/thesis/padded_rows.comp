// "GI BuildMatrix", thesis layout (T Fig. 7, T 5.4-5.6): one invocation per row traces its rays one after another and
// appends every hit as (column, weight), unmerged, to the row's fixed stride. A dispatch may trace a slice of the rays:
// lavapipe's loops end after 65,535 turns in all of an invocation, whatever their condition says.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "shared/constants.h"
#include "shared/matrix_build.h"

layout(local_size_x = 64) in;
layout(constant_id = CONSTANT_SLICE) const uint SLICE = 0xFFFFu;  // rays of one dispatch
layout(push_constant, scalar) uniform Push { PaddedRowsPush p; };

#include "gi/trace.glsl"

void main() {
  uint index = irad_index();
  if (index >= p.rows) return;
  uint row = p.firstRow + index;
  FacetArrays facets = p.facets;
  uint packedVoxel = facets.voxel.at[row];
  vec3 normal = decodeNormal(facets.shape.at[row] & 0xFFFFu, TRACE_NORMALS);
  vec3 origin = vec3(unpackVoxel(packedVoxel)) + 0.5f + normal;
  uvec4 shifts = rayShifts(packedVoxel, p.seed, p.jitter);
  TraceWorld world = TraceWorld(facets, p.chebyshev, p.dims, p.jfaMax);
  uint rays = p.slice & 0xFFFFu;
  uint first = p.slice >> 16;
  uint last = min(first + SLICE, rays);
  uint base = (p.segmentRow + index) * rays;
  uint weight = floatBitsToUint(1.0f / float(rays));
  uint before = first > 0u ? p.rowInfo.at[row].x : 0u;
  uint hits = before, escaped = 0u;
  for (uint k = first; k < last; ++k) {
    vec3 direction = toWorld(cosineDirection(hammersley(k, rays, shifts.xy)), normal);
    uint met = traceThesis(world, traceStart(origin, direction)).facet;
    if (met <= TRACE_LAST_FACET) {
      p.segment.at[base + hits] = uvec2(met, weight);
      ++hits;
    } else if (met == TRACE_ESCAPED) {
      ++escaped;
    }
  }
  p.rowInfo.at[row] = uvec2(hits, weight);
  atomicAdd(p.sums.at[0].hits, hits - before);
  atomicAdd(p.sums.at[0].escaped, escaped);
  atomicMax(p.sums.at[0].largestRow, hits);
}
