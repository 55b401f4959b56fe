// Indirect light at a point of a surface: the facets around it, gated so that light stays on its own surface
// (METHOD section 7), or the thesis's volume lookups (T 5.10).
#ifndef IRAD_FORWARD_INDIRECT_GLSL
#define IRAD_FORWARD_INDIRECT_GLSL
#include "shared/facets.h"
#include "shared/gi_params.h"
#include "shared/grid.h"
#include "shared/normals.h"

/// How well a facet of voxel `v` stands for a surface through `p` (voxel units) with normal `n`: 1 on the same plane,
/// 0 where it faces away or lies on another level (the far side of a thin wall, the next step of a stair).
float facetAgreement(uint shape, uint encoding, vec3 v, vec3 p, vec3 n) {
  vec3 m = decodeNormal(shape & 0xFFFFu, encoding);
  float facing = dot(m, n);
  if (facing <= 0.0) return 0.0;
  float plane = abs(dot(m, p - (v + 0.5)) - facetOffset(shape));
  return facing * facing * clamp(1.5 - plane, 0.0, 1.0);
}

/// Where lookups find the facets. By value: what is read through uniform pointers is read once for all lanes.
struct FacetMap {
  UintArray shape, reverse;
  uvec3 dims;
  uint encoding;
};

/// A voxel's entry of the reverse map; NO_FACET outside the grid.
uint facetEntry(FacetMap map, ivec3 v) {
  if (any(lessThan(v, ivec3(0))) || any(greaterThanEqual(v, ivec3(map.dims)))) return NO_FACET;
  return map.reverse.at[voxelIndex(uvec3(v), map.dims)];
}

/// The better of a voxel's facets; returns its index, or NO_FACET when neither agrees.
uint bestFacet(FacetMap map, ivec3 v, vec3 p, vec3 n, out float agreement) {
  agreement = 0.0;
  uint entry = facetEntry(map, v);
  if (entry == NO_FACET) return NO_FACET;
  uint facet = entry & ~SECOND_FACET;
  uint best = NO_FACET;
  agreement = facetAgreement(map.shape.at[facet], map.encoding, vec3(v), p, n);
  if (agreement > 0.0) best = facet;
  if ((entry & SECOND_FACET) != 0u) {
    float other = facetAgreement(map.shape.at[facet + 1u], map.encoding, vec3(v), p, n);
    if (other > agreement) {
      agreement = other;
      best = facet + 1u;
    }
  }
  return best;
}

/// The eight voxels whose centres surround `q`, gated for a surface through `p` with normal `n` (voxel units): the sum
/// of their facets' values and, in w, of the weights.
vec4 facetTaps(FacetMap map, Vec4Array values, vec3 q, vec3 p, vec3 n) {
  vec3 base = floor(q - 0.5);
  vec3 f = q - 0.5 - base;
  vec4 sum = vec4(0.0);
  for (int i = 0; i < 8; ++i) {
    ivec3 corner = ivec3(i & 1, (i >> 1) & 1, i >> 2);
    vec3 w = mix(1.0 - f, f, vec3(corner));
    float agreement;
    uint facet = bestFacet(map, ivec3(base) + corner, p, n, agreement);
    if (facet != NO_FACET) sum += w.x * w.y * w.z * agreement * vec4(values.at[facet].xyz, 1.0);
  }
  return sum;
}

/// The nearest facet of the 3 x 3 x 3 voxels around `p` that agrees with `n`, or NO_FACET.
uint nearestFacet(FacetMap map, vec3 p, vec3 n) {
  ivec3 centre = ivec3(floor(p));
  uint best = NO_FACET;
  float nearest = 1e9;
  for (int i = 0; i < 27; ++i) {
    ivec3 v = centre + ivec3(i % 3, (i / 3) % 3, i / 9) - 1;
    float agreement;
    uint facet = bestFacet(map, v, p, n, agreement);
    if (facet == NO_FACET) continue;
    vec3 d = p - (vec3(v) + 0.5);
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
vec3 facetsBeside(FacetMap map, Vec4Array values, vec3 p, vec3 n) {
  ivec3 centre = ivec3(floor(p));
  vec4 sum = vec4(0.0);
  for (int i = 0; i < 54; ++i) {
    ivec3 v = centre + ivec3((i / 2) % 3, (i / 6) % 3, i / 18) - 1;
    uint entry = facetEntry(map, v);
    if (entry == NO_FACET || (i % 2 == 1 && (entry & SECOND_FACET) == 0u)) continue;
    uint facet = (entry & ~SECOND_FACET) + uint(i % 2);
    uint shape = map.shape.at[facet];
    vec3 m = decodeNormal(shape & 0xFFFFu, map.encoding);
    vec3 d = vec3(v) + 0.5 + m * facetOffset(shape) - p;
    if (dot(m, n) > -0.5) sum += vec4(values.at[facet].xyz, 1.0) / (0.1 + dot(d, d));
  }
  return sum.w > 0.0 ? sum.rgb / sum.w : vec3(0.0);
}

/// Gated lookup of shading at `p` (voxel units), offset along the normal (METHOD section 7).
vec3 facetIndirect(FacetMap map, Vec4Array values, SampleParams sampling, vec3 p, vec3 n) {
  if (sampling.filter_ != FILTER_NEAREST) {
    vec4 sum = facetTaps(map, values, p + n * sampling.normalOffset, p, n);
    if (sum.w >= 1.0 / 256.0) return sum.rgb / sum.w;
  }
  uint facet = nearestFacet(map, p, n);
  return facet != NO_FACET ? values.at[facet].xyz : facetsBeside(map, values, p, n);
}

/// The value at `p` on the surface of `facet`, whose normal is `n`; its own where nothing else agrees.
vec3 facetValueAround(FacetMap map, Vec4Array values, uint facet, vec3 p, vec3 n) {
  vec4 sum = facetTaps(map, values, p, p, n);
  return sum.w >= 1.0 / 256.0 ? sum.rgb / sum.w : values.at[facet].xyz;
}

#ifdef IRAD_VOLUME
/// The thesis's lookups in the RGBA16F volume at `p` (voxel units): the texel, the hardware's trilinear filter, or 3 x
/// 3 x 3 trilinear taps half a voxel apart. Where presence is below 1/256 the nearest solid texel of the 3 x 3 x 3
/// around p is taken instead of dividing by it.
vec3 volumeIndirect(Grid grid, SampleParams sampling, vec3 p, vec3 n) {
  vec3 q = p + n * sampling.normalOffset;
  vec3 size = vec3(grid.dims);
  vec4 c = vec4(0.0);
  if (sampling.filter_ == FILTER_NEAREST) {
    c = texelFetch(indirectVolume, clamp(ivec3(floor(q)), ivec3(0), ivec3(grid.dims) - 1), 0);
  } else if (sampling.filter_ == FILTER_LINEAR) {
    c = textureLod(indirectVolume, q / size, 0.0);
  } else {
    for (int i = 0; i < 27; ++i)
      c += textureLod(indirectVolume, (q + 0.5 * (vec3(i % 3, (i / 3) % 3, i / 9) - 1.0)) / size, 0.0) / 27.0;
  }
  if (sampling.premultiplied == 0u) return c.rgb;
  if (c.a >= 1.0 / 256.0) return c.rgb / c.a;  // T eq. 24
  float nearest = 1e9;
  vec3 found = vec3(0.0);
  for (int i = 0; i < 27; ++i) {
    ivec3 v = ivec3(floor(p)) + ivec3(i % 3, (i / 3) % 3, i / 9) - 1;
    if (any(lessThan(v, ivec3(0))) || any(greaterThanEqual(v, ivec3(grid.dims)))) continue;
    vec4 texel = texelFetch(indirectVolume, v, 0);
    vec3 d = q - (vec3(v) + 0.5);
    if (texel.a >= 1.0 / 256.0 && dot(d, d) < nearest) {
      nearest = dot(d, d);
      found = texel.rgb / texel.a;
    }
  }
  return found;
}
#endif

#endif
