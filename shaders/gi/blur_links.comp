// "GI Scatter": H as shading samples it, once per relight instead of once per pixel (docs/method.md 7): between the
// facet's own and the mean with tent weights over the facets of the 3 x 3 x 3 voxels around that continue the surface,
// each as much as it has area; by how much of what they differ by the noise of their rays accounts for.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "gi/surface_point.h"
#include "shared/constants.h"
layout(local_size_x = 64) in;
layout(constant_id = CONSTANT_EMITTED) const bool EMITTED = true;        ///< F M too
layout(constant_id = CONSTANT_SCATTER_STORES) const bool STORES = true;  ///< false: it only measures the change
layout(constant_id = CONSTANT_BLUR_WEIGHS) const bool WEIGHS = true;     ///< false: the noise is not known; the mean alone
layout(push_constant, scalar) uniform Push { BlurLinksPush p; };

float sumOf(vec3 v) { return v.x + v.y + v.z; }

void main() {
  uint facet = irad_index();
  if (facet >= p.count) return;
  SurfaceArrays surface = p.surface.at[0];
  FacetLinks links = linksOf(surface, facet, p.voxel.at[facet]);
  vec3 own = p.indirect.at[facet].xyz;
  vec3 sumH = vec3(0.0), sumE = vec3(0.0);
  float sumSquares = 0.0, sumNoise = 0.0, sumVariance = 0.0, ownWeight = 0.0, total = 0.0;
  for (uint i = 0u; i < 27u; ++i) {
    uint other = linkedFacet(surface, p.reverse, p.dims, links, i);
    if (other == NO_FACET) continue;
    ivec3 step_ = stepTo(i);
    float weight = (step_.x == 0 ? 2.0 : 1.0) * (step_.y == 0 ? 2.0 : 1.0) * (step_.z == 0 ? 2.0 : 1.0) *
                   max(surface.area.at[other], 1e-6);
    vec3 h = p.indirect.at[other].xyz;
    sumH += weight * h;
    if (EMITTED) {
      vec4 emitted = p.emitted.at[other];
      sumE += weight * emitted.xyz;
      sumVariance += weight * weight * emitted.w;
      if (i == OWN_VOXEL) ownWeight = weight;
    }
    if (WEIGHS) {
      // About the facet's own H: sums of squares of H itself would lose what small differences there are.
      vec3 off = h - own, error = p.error.at[other].xyz;
      sumSquares += weight * dot(off, off);
      sumNoise += weight * dot(error, error);
    }
    total += weight;
  }
  vec3 mean = sumH / total;  // the facet itself is always linked
  // Lee 1980: the share of the variance that noise does not account for is kept.
  float keep = 0.0;
  if (WEIGHS) {
    vec3 shift = mean - own;
    float variance = sumSquares / total - dot(shift, shift), noise = sumNoise / total;
    if (variance > noise) keep = 1.0 - noise / variance;
  }
  if (STORES) p.blurred.at[facet] = vec4(mix(mean, own, keep), 0.0);
  if (STORES && EMITTED) {
    vec4 emitted = p.emitted.at[facet];
    // The variance that is left of the samples', w; the facet's own are in the mean, too.
    float inMean = (1.0 - keep) / total;
    float variance = inMean * inMean * sumVariance + keep * (keep + 2.0 * inMean * ownWeight) * emitted.w;
    p.blurredEmitted.at[facet] = vec4(mix(sumE / total, emitted.xyz, keep), variance);
  }
  // At most: what is kept is not known where nothing is stored, and the plan wants one number either way.
  vec3 change = abs(mean - own);
  uint bits = floatBitsToUint(max(change.r, max(change.g, change.b)));
  if (bits > p.change.at[0]) atomicMax(p.change.at[0], bits);
}
