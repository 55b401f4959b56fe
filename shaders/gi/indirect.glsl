// Indirect light at a point of a surface: the facets around it, gated so that light stays on its own surface
// (docs/method.md 7).
#ifndef IRAD_GI_INDIRECT_GLSL
#define IRAD_GI_INDIRECT_GLSL
#include "gi/facet_map.glsl"
#include "shared/gi_params.h"

/// How well a facet of voxel `v` stands for the receiver's surface: 1 on the same plane, 0 where it faces away or lies
/// on another level (the far side of a thin wall, the next step of a stair).
float facetAgreement(uint shape, uint encoding, vec3 v, Receiver r) {
  vec3 m = decodeNormal(shape & 0xFFFFu, encoding);
  float facing = dot(m, r.normal);
  if (facing <= 0.0) return 0.0;
  float plane = abs(dot(m, r.position - (v + 0.5)) - facetOffset(shape));
  return facing * facing * clamp(1.5 - plane, 0.0, 1.0);
}

/// Finds the best of a voxel's facets; returns its index, or NO_FACET when none agrees or a wall hides it.
uint bestFacet(FacetMap map, ivec3 v, Receiver r, out float agreement) {
  agreement = 0.0;
  uint entry = facetEntry(map, v);
  if (entry == NO_FACET || hiddenVoxel(r, vec3(v) + 0.5)) return NO_FACET;
  uint facet = NO_FACET;
  uint shape = 0u;
  for (uint i = firstFacet(entry); i < firstFacet(entry) + facetsOf(entry); ++i) {
    uint candidate = map.shape.at[i];
    float agrees = facetAgreement(candidate, map.encoding, vec3(v), r);
    if (agrees <= agreement) continue;
    agreement = agrees;
    facet = i;
    shape = candidate;
  }
  bool hidden = facet != NO_FACET && hiddenByWalls(map, entry, facet, shape, r.normal, r.position - vec3(v) - 0.5);
  return hidden ? NO_FACET : facet;
}

/// The eight voxels whose centres surround `q`: the sum of their facets' values, as they stand for the receiver's
/// surface, and, in w, of the weights.
vec4 facetTaps(FacetMap map, Vec4Array values, vec3 q, Receiver r) {
  vec3 base = floor(q - 0.5);
  vec3 f = q - 0.5 - base;
  vec4 sum = vec4(0.0);
  for (int i = 0; i < 8; ++i) {
    ivec3 corner = ivec3(i & 1, (i >> 1) & 1, i >> 2);
    vec3 w = mix(1.0 - f, f, vec3(corner));
    float agreement;
    uint facet = bestFacet(map, ivec3(base) + corner, r, agreement);
    if (facet != NO_FACET) sum += w.x * w.y * w.z * agreement * vec4(values.at[facet].xyz, 1.0);
  }
  return sum;
}

/// The nearest facet of the 3 x 3 x 3 voxels around the receiver that agrees with its normal, or NO_FACET.
uint nearestFacet(FacetMap map, Receiver r) {
  ivec3 centre = ivec3(floor(r.position));
  uint best = NO_FACET;
  float nearest = 1e9;
  for (int i = 0; i < 27; ++i) {
    ivec3 v = centre + ivec3(i % 3, (i / 3) % 3, i / 9) - 1;
    float agreement;
    uint facet = bestFacet(map, v, r, agreement);
    if (facet == NO_FACET) continue;
    vec3 d = r.position - (vec3(v) + 0.5);
    float distance2 = dot(d, d) + 1.0 - agreement;
    if (distance2 < nearest) {
      nearest = distance2;
      best = facet;
    }
  }
  return best;
}

/// The rim of a slab thinner than a voxel has no facet, because its voxels keep the slab's two sides: it takes the mean
/// of the facets around that do not face away, the nearer the more.
vec3 facetsBeside(FacetMap map, Vec4Array values, Receiver r) {
  ivec3 centre = ivec3(floor(r.position));
  vec4 sum = vec4(0.0);
  for (int i = 0; i < 27; ++i) {
    ivec3 v = centre + ivec3(i % 3, (i / 3) % 3, i / 9) - 1;
    uint entry = facetEntry(map, v);
    if (entry == NO_FACET || hiddenVoxel(r, vec3(v) + 0.5)) continue;
    for (uint facet = firstFacet(entry); facet < firstFacet(entry) + facetsOf(entry); ++facet) {
      uint shape = map.shape.at[facet];
      vec3 m = decodeNormal(shape & 0xFFFFu, map.encoding);
      vec3 d = vec3(v) + 0.5 + m * facetOffset(shape) - r.position;
      if (dot(m, r.normal) > -0.5) sum += vec4(values.at[facet].xyz, 1.0) / (0.1 + dot(d, d));
    }
  }
  return sum.w > 0.0 ? sum.rgb / sum.w : vec3(0.0);
}

/// Gated lookup of shading, offset along the normal (docs/method.md 7).
vec3 facetIndirect(FacetMap map, Vec4Array values, SampleParams sampling, Receiver r) {
  if (sampling.filter_ != FILTER_NEAREST) {
    vec4 sum = facetTaps(map, values, r.position + r.normal * sampling.normalOffset, r);
    if (sum.w >= 1.0 / 256.0) return sum.rgb / sum.w;
  }
  uint facet = nearestFacet(map, r);
  return facet != NO_FACET ? values.at[facet].xyz : facetsBeside(map, values, r);
}

/// The value at `p` on the surface of `facet`, whose normal is `n`, seen from the direction `viewer`; its own where
/// nothing else agrees.
vec3 facetValueAround(FacetMap map, Vec4Array values, uint facet, vec3 p, vec3 n, vec3 viewer) {
  vec4 sum = facetTaps(map, values, p, receiverAt(map, p, n, viewer));
  return sum.w >= 1.0 / 256.0 ? sum.rgb / sum.w : values.at[facet].xyz;
}

#endif
