// "GI Scatter": H as shading samples it, once per relight instead of once per pixel (docs/method.md 7): averaged with
// tent weights over the facets of the 3 x 3 x 3 voxels around that continue the surface, each as much as it has area.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "gi/surface_point.glsl"
#include "shared/constants.h"
layout(local_size_x = 64) in;
layout(constant_id = CONSTANT_EMITTED) const bool EMITTED = true;        ///< F M too
layout(constant_id = CONSTANT_SCATTER_STORES) const bool STORES = true;  ///< false: it only measures the change
layout(push_constant, scalar) uniform Push { BlurLinksPush p; };

void main() {
  uint facet = irad_index();
  if (facet >= p.count) return;
  SurfaceArrays surface = p.surface.at[0];
  ivec3 voxel = ivec3(unpackVoxel(p.voxel.at[facet]));
  vec3 unblurred = p.indirect.at[facet].xyz;
  vec3 sumH = vec3(0.0), sumE = vec3(0.0), sumV = vec3(0.0), sumN = vec3(0.0);
  float total = 0.0;
  for (uint i = 0u; i < 27u; ++i) {
    uint link = facetLink(surface, facet, i);
    if (link == NO_LINK) continue;
    ivec3 step_ = ivec3(i % 3u, (i / 3u) % 3u, i / 9u) - 1;
    uint other = firstFacet(p.reverse.at[voxelIndex(uvec3(voxel + step_), p.dims)]) + link;
    float weight = (step_.x == 0 ? 2.0 : 1.0) * (step_.y == 0 ? 2.0 : 1.0) * (step_.z == 0 ? 2.0 : 1.0) *
                   max(surface.area.at[other], 1e-6);
    vec3 hh = p.indirect.at[other].xyz;
    sumH += weight * hh;
    vec3 m1 = hh;
    if (p.emissionGain != 0.0) m1 -= p.emissionGain * p.emitted.at[other].xyz;
    if (uint64_t(p.sky) != 0ul) m1 -= p.sky.at[other].xyz;
    sumN += weight * max(p.squares.at[other].xyz - m1 * m1, vec3(0.0));
    vec3 d = hh - unblurred;
    sumV += weight * d * d;
    if (EMITTED) sumE += weight * p.emitted.at[other].xyz;
    total += weight;
  }
  vec3 h = sumH / total;  // the facet itself is always linked
  vec3 own = h - unblurred;
  vec3 var_ = sumV / total - own * own;
  float V = var_.x + var_.y + var_.z, S = p.noise * (sumN.x + sumN.y + sumN.z) / total;
  float keep = V > S ? 1.0 - S / V : 0.0;
  h = mix(h, unblurred, keep);
  if (STORES) p.blurred.at[facet] = vec4(h, 0.0);
  if (STORES && EMITTED) p.blurredEmitted.at[facet] = vec4(mix(sumE / total, p.emitted.at[facet].xyz, keep), 0.0);
  vec3 change = abs(h - unblurred);
  uint bits = floatBitsToUint(max(change.r, max(change.g, change.b)));
  if (bits > p.change.at[0]) atomicMax(p.change.at[0], bits);
}
