// "GI Writeback Clear": no pixel has seen a facet yet; and the brightest light that a pixel may reflect.
#version 460
#extension GL_GOOGLE_include_directive : require
#extension GL_KHR_shader_subgroup_arithmetic : require
#include "shared/writeback.h"

layout(local_size_x = 64) in;
layout(push_constant, scalar) uniform Push { WritebackFacetsPush p; };

void main() {
  uint facet = irad_index();
  float brightest = 0.0f;
  if (facet < p.facets) {
    p.pixels.at[facet] = 0u;
    if (uint64_t(p.writers) != 0ul) p.writers.at[facet] = 0u;
    const uint words = uint64_t(p.sums) != 0ul ? 3u * WRITEBACK_PARTS : 0u;
    for (uint i = 0u; i < words; ++i) p.sums.at[words * facet + i] = 0u;
    vec3 b = p.radiosity.at[facet].xyz;
    brightest = max(b.x, max(b.y, b.z));
    if (!(brightest > 0.0f)) brightest = 0.0f;
  }
  brightest = subgroupMax(brightest);
  if (subgroupElect()) atomicMax(p.counts.at[0].brightest, floatBitsToUint(brightest));
}
