#version 460
#extension GL_GOOGLE_include_directive : require
// "GI Solve Energy": the light that enters, is absorbed and escapes, summed over some facets per invocation. No atomics,
// so that the sums are the same bits in every run; the host adds them up in double.
#include "shared/constants.h"
#include "shared/energy.h"

layout(local_size_x = 64) in;
layout(constant_id = CONSTANT_SKY) const bool SKY = false;
layout(constant_id = CONSTANT_REFLECTED) const bool REFLECTED = false;
layout(constant_id = CONSTANT_FRAMES) const bool FRAMES = false;
layout(push_constant, scalar) uniform Push { EnergyPush p; };

void main() {
  uint me = irad_index();
  if (me >= p.invocations) return;
  FacetArrays f = p.facets.at[0];
  EnergySums sum = EnergySums(vec3(0.0f), vec3(0.0f), vec3(0.0f));
  for (uint facet = me; facet < f.count; facet += p.invocations) {
    float area = p.area.at[facet];
    vec3 direct = p.direct.at[facet].xyz;
    vec3 exitance = f.hasEmission != 0u ? f.emission.at[facet] : vec3(0.0f);
    sum.entering += area * (exitance + direct);
    if (SKY) sum.entering += area * p.sky.at[facet].xyz;
    if (REFLECTED) sum.entering += area * p.reflected.at[facet].xyz;
    sum.absorbed += area * (vec3(1.0f) - unpackAlbedo(f.albedo.at[facet])) * (direct + p.indirect.at[facet].xyz);
    float rowSum;
    if (FRAMES) {
      vec4 kept = p.frames.at[facet];  // as a whole, as in gi/brute_force.comp
      rowSum = kept.w;
    } else {
      rowSum = p.rowSum.at[facet];
    }
    sum.escaped += area * (1.0f - rowSum) * p.radiosity.at[facet].xyz;
  }
  p.sums.at[me] = sum;
}
