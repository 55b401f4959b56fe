#version 460
#extension GL_GOOGLE_include_directive : require
// "GI CompactList", last step: which facets share their voxel with surfaces that only the voxels around record.
#include "shared/grid.h"
#include "shared/normals.h"
#include "shared/trace.h"

layout(local_size_x = 64) in;
layout(constant_id = 0) const uint NORMALS = NORMALS_OCT16;
layout(push_constant, scalar) uniform Push { FacetCornersPush p; };

const float REACH = 0.9f;  // voxels: half a cell's diagonal and what planes are known to

void main() {
  uint facet = irad_index();
  FacetArrays f = p.facets.at[0];
  if (facet >= f.count) return;
  uint shape = f.shape.at[facet];
  vec3 normal = decodeNormal(shape & 0xFFFFu, NORMALS);
  ivec3 voxel = ivec3(unpackVoxel(f.voxel.at[facet]));
  bool corner = false;
  for (int i = 0; i < 27; ++i) {
    ivec3 step_ = ivec3(i % 3, (i / 3) % 3, i / 9) - 1;
    ivec3 at = voxel + step_;
    if (i == 13 || any(lessThan(at, ivec3(0))) || any(greaterThanEqual(at, ivec3(p.dims)))) continue;
    uint entry = f.reverse.at[voxelIndex(uvec3(at), p.dims)];
    if (entry == NO_FACET) continue;
    uint first = entry & ~SECOND_FACET;
    uint last = entry >= SECOND_FACET ? first + 1u : first;
    for (uint other = first; other <= last; ++other) {
      // Neighbours may be setting their own bit meanwhile; the bits read here do not change.
      uint otherShape = f.shape.at[other];
      vec3 otherNormal = decodeNormal(otherShape & 0xFFFFu, NORMALS);
      float centre = -dot(otherNormal, vec3(step_)) - facetOffset(otherShape);
      corner = corner || (dot(normal, otherNormal) < TRACE_OWN_NORMAL && abs(centre) < REACH);
    }
  }
  if (corner) atomicOr(f.shape.at[facet], FACET_CORNER);
}
