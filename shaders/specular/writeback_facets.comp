// "GI Writeback", last: W of every facet, 0 where no pixel has written, and what there is to say of it. One invocation
// per facet. IRAD_MASK: of what the mask's fragments have stored; otherwise the mean of the facet's pixels.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "shared/writeback.h"

layout(local_size_x = 64) in;
layout(push_constant, scalar) uniform Push { WritebackFacetsPush p; };
#ifdef IRAD_MASK
layout(set = 0, binding = 0, rgba32f) uniform readonly image2D stored;
#endif

// A workgroup's share of the counts.
shared uint writersShared[WRITEBACK_BINS], stores, change, largest;

float sumOf(uint facet, uint channel) {
  uint word = WRITEBACK_PARTS * (3u * facet + channel);
  float sum = 0.0f;
  for (uint part = WRITEBACK_PARTS; part-- > 0u;) sum = 256.0f * sum + float(p.sums.at[word + part]);
  return sum / WRITEBACK_STEPS;
}

void main() {
  if (gl_LocalInvocationIndex < WRITEBACK_BINS) writersShared[gl_LocalInvocationIndex] = 0u;
  if (gl_LocalInvocationIndex == 0u) stores = change = largest = 0u;
  barrier();
  uint facet = irad_index();
  if (facet < p.facets) {
    uint pixels = p.pixels.at[facet];
    vec3 w = vec3(0.0f);
#ifdef IRAD_MASK
    uint writers = p.writers.at[facet];
    atomicAdd(stores, writers);
    if (writers > 0u) w = imageLoad(stored, writebackTexel(facet)).rgb;
#else
    uint writers = min(pixels, 1u);
    atomicAdd(stores, pixels);
    if (pixels > 0u) {
      float most = uintBitsToFloat(p.counts.at[0].most);
      w = vec3(sumOf(facet, 0u), sumOf(facet, 1u), sumOf(facet, 2u)) / float(pixels) * most;
    }
#endif
    w = mix(w, vec3(0.0f), lessThan(w, vec3(p.flush)));
    vec3 d = abs(w - p.used.at[facet].xyz);
    p.drawn.at[facet] = vec4(w, float(writers));
    if (pixels > 0u) atomicAdd(writersShared[min(writers, WRITEBACK_BINS - 1u)], 1u);
    atomicMax(change, floatBitsToUint(max(d.x, max(d.y, d.z))));
    atomicMax(largest, floatBitsToUint(max(w.x, max(w.y, w.z))));
  }
  barrier();
  if (gl_LocalInvocationIndex < WRITEBACK_BINS && writersShared[gl_LocalInvocationIndex] > 0u)
    atomicAdd(p.counts.at[0].writers[gl_LocalInvocationIndex], writersShared[gl_LocalInvocationIndex]);
  if (gl_LocalInvocationIndex != 0u) return;
  if (stores > 0u) atomicAdd(p.counts.at[0].stores, stores);
  if (change > 0u) atomicMax(p.counts.at[0].change, change);
  if (largest > 0u) atomicMax(p.counts.at[0].largest, largest);
}
