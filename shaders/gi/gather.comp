#version 460
#extension GL_GOOGLE_include_directive : require
// "GI Gather" (docs/method.md 6, T 5.7): direct irradiance D of every facet from the sun, spot and point lights,
// averaged over points of the facet's plane within its cell, through the shadow maps and the very functions that
// shading uses.
#include "shared/constants.h"
#include "shared/solve.h"
#define IRAD_LIGHT_CONSTANTS GATHER_LIGHTS
#include "forward/shadow.glsl"
#include "shared/grid.h"
#include "shared/normals.h"
#include "shared/trace.h"

layout(local_size_x = 64) in;
layout(constant_id = CONSTANT_NORMALS) const uint NORMALS = NORMALS_OCT16;
layout(push_constant, scalar) uniform Push { GatherPush p; };

// The facet's plane may lie this far below bumps of the surface inside its voxel: shadow lookups start above them.
const float LIFT = 0.25f;  // voxels

void main() {
  uint facet = irad_index();
  FacetArrays f = p.facets.at[0];
  if (facet >= f.count) return;
  uvec3 voxel = unpackVoxel(f.voxel.at[facet]);
  uint shape = f.shape.at[facet];
  vec3 normal = decodeNormal(shape & 0xFFFFu, NORMALS);
  GpuScene scene = p.scene.at[0];
  vec3 sum = vec3(0.0f);
  for (uint k = 0u; k < p.samples; ++k) {
    vec2 jitter = hammersley(k, p.samples, uvec2(0u, 0x80000000u / p.samples));
    vec3 position = p.origin + p.edge * facetPoint(voxel, normal, facetOffset(shape), jitter);
    for (uint i = 0u; anyLight() && i < scene.lightCount; ++i) {
      GpuLight light = scene.lights.at[i];
      vec3 irradiance = lightIrradiance(light, position, normal);
      if (irradiance == vec3(0.0f)) continue;
      sum += irradiance * shadowVisibility(light, position + normal * (LIFT * p.edge), normal, p.shadowBias, p.pcf);
    }
  }
  p.direct.at[facet] = vec4(sum / float(p.samples), 0.0f);
}
