#version 460
#extension GL_GOOGLE_include_directive : require
// "GI Scatter" (T 5.9): one value per solid voxel into the sampled volume, alpha 1 marks presence. H, or B; with edge
// removal B - lambda (M + rho D) (T eq. 23). A voxel shows its first facet.
#include "shared/grid.h"
#include "shared/solve.h"

layout(local_size_x = 64) in;
layout(push_constant, scalar) uniform Push { ScatterVolumePush p; };
layout(set = 0, binding = 0, rgba16f) uniform writeonly image3D volume;

void main() {
  uint facet = irad_index();
  FacetArrays f = p.facets.at[0];
  if (facet >= f.count) return;
  uvec3 voxel = unpackVoxel(f.voxel.at[facet]);
  if (firstFacet(f.reverse.at[voxelIndex(voxel, p.dims)]) != facet) return;
  vec3 value = p.radiosity.at[facet].xyz;
  if (p.removal > 0.0f) {
    vec3 source = unpackAlbedo(f.albedo.at[facet]) * p.direct.at[facet].xyz;
    if (f.hasEmission != 0u) source += f.emission.at[facet];
    value -= p.removal * source;
  }
  if (any(greaterThan(value, vec3(HALF_MAX)))) atomicAdd(p.clamped.at[0], 1u);
  imageStore(volume, ivec3(voxel), vec4(clamp(value, vec3(0.0f), vec3(HALF_MAX)), 1.0f));
}
