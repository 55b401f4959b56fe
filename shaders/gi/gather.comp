#version 460
#extension GL_GOOGLE_include_directive : require
// "GI Gather" where facets are planes (docs/method.md 6, T 5.7): direct irradiance D of every facet from the sun, spot
// and point lights, at its middle, through the shadow maps and the very functions that shading uses.
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

// A plane facet may lie this far below bumps of the surface inside its voxel: shadow lookups start above them.
const float LIFT = 0.25f;  // voxels

void main() {
  uint facet = irad_index();
  FacetArrays f = p.facets.at[0];
  if (facet >= f.count) return;
  uvec3 voxel = unpackVoxel(f.voxel.at[facet]);
  uint shape = f.shape.at[facet];
  vec3 normal = decodeNormal(shape & 0xFFFFu, NORMALS);
  GpuScene scene = p.scene.at[0];
  // At its middle: T 5.7 takes one sample.
  vec3 middle = facetPoint(voxel, normal, facetOffset(shape), hammersley(0u, 1u, uvec2(0u, 0x80000000u)));
  vec3 position = p.origin + p.edge * middle;
  vec3 sum = vec3(0.0f);
  for (uint i = 0u; anyLight() && i < scene.lightCount; ++i) {
    GpuLight light = scene.lights.at[i];
    vec3 irradiance = lightIrradiance(light, position, normal);
    if (irradiance == vec3(0.0f)) continue;
    sum += irradiance * shadowVisibility(light, position + normal * (LIFT * p.edge), normal, p.shadowBias, p.pcf);
  }
  p.direct.at[facet] = vec4(sum, 0.0f);
}
