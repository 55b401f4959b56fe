#version 460
#extension GL_GOOGLE_include_directive : require
// "GI BruteForce" (docs/method.md 9, T 5.13), one subgroup per facet: sums what its rays of this frame bring, takes it
// into the mean over the frames and into the mean's standard error, and makes B for the rays of the next frame.
#include "gi/tinted.glsl"
#include "shared/brute_force.h"
#include "shared/constants.h"

layout(local_size_x = 128) in;
layout(constant_id = CONSTANT_SKY) const bool SKY = false;
layout(constant_id = CONSTANT_EMITTED) const bool EMITTED = false;
layout(push_constant, scalar) uniform Push { BruteForcePush p; };

#include "gi/solve_watch.glsl"

/// What a facet's rays bring.
struct Brought {
  vec3 light, emitted;  ///< sums over the rays of B (of the sky pi L), and of M
  uint met, counted;    ///< rays that met a facet; that count, being neither invalid nor not cast
};

void addRay(inout Brought sum, FacetArrays f, uint met) {
  if (met == TRACE_NOT_CAST || met == TRACE_INVALID) return;
  ++sum.counted;
  if (met <= TRACE_LAST_FACET) {
    ++sum.met;
    vec3 open = vec3(1.0f);
    if (TINTED) {
      open = openChannels(met >> TINT_SHIFT_FRAMES);
      met &= (1u << TINT_SHIFT_FRAMES) - 1u;
    }
    sum.light += open * p.from.at[met].xyz;
    if (EMITTED) sum.emitted += open * f.emission.at[met];
  } else if (SKY && isSky(met)) {
    uint bin = met - TRACE_SKY;
    vec3 open = vec3(1.0f);
    if (TINTED) {
      open = openChannels(bin >> TINT_SHIFT_SKY);
      bin &= (1u << TINT_SHIFT_SKY) - 1u;
    }
    sum.light += open * (IRAD_PI * p.bins.at[bin].xyz);
  }
}

Watch finishFacet(FacetArrays f, uint facet, Brought sum) {
  float weight = sum.counted > 0u ? 1.0f / float(sum.counted) : 0.0f;
  vec3 h = sum.light * weight;
  h = mix(h, vec3(0.0f), lessThan(abs(h), vec3(p.flush)));
  vec3 rho = unpackAlbedo(f.albedo.at[facet]);
  vec3 source = rho * p.direct.at[facet].xyz;
  if (EMITTED) source += f.emission.at[facet];

  // By weights, after West (1979): the mean, and the variance about it, which is kept as the standard error.
  vec3 mean = h, error = vec3(0.0f);
  float rowSum = float(sum.met) * weight;
  bool first = p.share == 1.0f;  // what is there is of no earlier frame, and may be no number
  if (!first) {
    vec4 kept = p.standardError.at[facet];  // as a whole: of .w alone Mesa's CPU driver (22.3) makes .x
    vec3 before = p.indirect.at[facet].xyz, errorBefore = kept.xyz, off = h - before;
    mean = before + p.share * off;
    vec3 variance = (1.0f - p.share) * (p.toVariance * errorBefore * errorBefore + p.share * off * off);
    error = sqrt(p.toError * variance);
    rowSum = mix(kept.w, rowSum, p.share);
  }
  p.indirect.at[facet] = vec4(mean, 0.0f);
  p.standardError.at[facet] = vec4(error, rowSum);
  if (EMITTED) {
    vec3 emitted = sum.emitted * weight;
    if (!first) emitted = mix(p.emitted.at[facet].xyz, emitted, p.share);
    p.emitted.at[facet] = vec4(emitted, 0.0f);
  }
  vec3 radiosity = p.lambda * (source + rho * mean);
  p.radiosity.at[facet] = vec4(radiosity, 0.0f);
  vec3 next = p.lambda * (source + rho * h);
  if (p.omega != 1.0f && p.rays > 0u) next = mix(p.from.at[facet].xyz, next, p.omega);
  p.to.at[facet] = vec4(next, 0.0f);

  Watch w = NOTHING;
  watchLight(w, source, mean, radiosity);
  if (w.nonFinite == 0u) w.gain = p.lambda * largestOf(rho) * float(sum.met) * weight;
  return w;
}

void main() {
  FacetArrays f = p.facets.at[0];
  uint subgroups = gl_NumWorkGroups.x * gl_NumWorkGroups.y * gl_NumSubgroups;
  Watch w = NOTHING;
  for (uint i = irad_workgroup() * gl_NumSubgroups + gl_SubgroupID; i < p.count; i += subgroups) {
    Brought sum = Brought(vec3(0.0f), vec3(0.0f), 0u, 0u);
    for (uint k = gl_SubgroupInvocationID; k < p.rays; k += gl_SubgroupSize) addRay(sum, f, p.hits.at[i * p.rays + k]);
    sum.light = subgroupAdd(sum.light);
    if (EMITTED) sum.emitted = subgroupAdd(sum.emitted);
    sum.met = subgroupAdd(sum.met);
    sum.counted = subgroupAdd(sum.counted);
    if (subgroupElect()) addWatch(w, finishFacet(f, p.firstFacet + i, sum));
  }
  reduceWatch(w, p.residual, /*gains=*/false);
}
