#version 460
#extension GL_GOOGLE_include_directive : require
// "GI Scatter": H as shading samples it, once per relight instead of once per pixel (docs/method.md 7). Averages over
// the facets of the 3 x 3 x 3 voxels around that face the same way and lie in the same plane, with tent weights, so
// that neither a room behind the wall nor the next step of a stair comes in; nor the floor beyond a wall that stands on
// it.
#include "gi/facet_map.glsl"
#include "shared/constants.h"
#include "shared/solve.h"

layout(local_size_x = 64) in;
layout(constant_id = CONSTANT_NORMALS) const uint NORMALS = NORMALS_OCT16;
layout(constant_id = CONSTANT_EMITTED) const bool EMITTED = true;  ///< F M too
layout(constant_id = CONSTANT_SCATTER_STORES) const bool STORES = true;   ///< false: it only measures the change
layout(push_constant, scalar) uniform Push { ScatterFacetsPush p; };

const float FACING = 0.5f;  // least cosine between the normals
const float LEVEL = 0.5f;   // voxels: farthest that a parallel face on the same level is from the own plane

/// The same for a face `chord` away that is turned against the own one: a curved surface leaves the plane.
float level(float facing, vec3 chord) {
  return LEVEL + sqrt(max(0.0f, 1.0f - facing * facing)) * length(chord);
}

void main() {
  uint facet = irad_index();
  FacetArrays f = p.facets.at[0];
  if (facet >= f.count) return;
  vec3 unblurred = p.indirect.at[facet].xyz;
  vec3 h = unblurred;
  vec3 e = EMITTED ? p.emitted.at[facet].xyz : vec3(0.0f);
  FacetMap map = FacetMap(f.shape, f.reverse, f.around, p.dims, NORMALS);
  uvec3 voxel = unpackVoxel(f.voxel.at[facet]);
  uint shape = f.shape.at[facet];
  vec3 normal = decodeNormal(shape & 0xFFFFu, NORMALS);
  float offset = facetOffset(shape);
  uint own = facetEntry(map, ivec3(voxel));
  vec3 sumH = vec3(0.0f), sumE = vec3(0.0f);
  float total = 0.0f;
  for (int i = 0; i < 27; ++i) {
    ivec3 step_ = ivec3(i % 3, (i / 3) % 3, i / 9) - 1;
    uint entry = facetEntry(map, ivec3(voxel) + step_);
    if (entry == NO_FACET) continue;
    float tent = (step_.x == 0 ? 2.0f : 1.0f) * (step_.y == 0 ? 2.0f : 1.0f) * (step_.z == 0 ? 2.0f : 1.0f);
    uint first = firstFacet(entry);
    for (uint other = first; other < first + facetsOf(entry); ++other) {
      uint otherShape = f.shape.at[other];
      vec3 otherNormal = decodeNormal(otherShape & 0xFFFFu, NORMALS);
      // Both ways: the other's plane point from the own plane, and the own point from the other plane.
      vec3 chord = vec3(step_) + otherNormal * facetOffset(otherShape) - normal * offset;
      float away = dot(normal, chord);
      float back = dot(otherNormal, chord);
      float facing = dot(normal, otherNormal);
      if (facing <= FACING || max(abs(away), abs(back)) > level(facing, chord)) continue;
      if (other != facet &&
          (hiddenByWalls(map, own, facet, shape, normal, vec3(step_) + otherNormal * facetOffset(otherShape)) ||
           hiddenByWalls(map, entry, other, otherShape, otherNormal, normal * offset - vec3(step_))))
        continue;
      sumH += tent * p.indirect.at[other].xyz;
      if (EMITTED) sumE += tent * p.emitted.at[other].xyz;
      total += tent;
    }
  }
  if (total > 0.0f) {  // the facet itself always agrees; 0 only with a normal that is not a number
    h = sumH / total;
    e = sumE / total;
  }
  if (STORES) p.blurred.at[facet] = vec4(h, 0.0f);
  if (STORES && EMITTED) p.blurredEmitted.at[facet] = vec4(e, 0.0f);
  vec3 change = abs(h - unblurred);
  uint bits = floatBitsToUint(max(change.r, max(change.g, change.b)));
  if (bits > p.change.at[0]) atomicMax(p.change.at[0], bits);
}
