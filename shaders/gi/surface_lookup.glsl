// Values of facets at a point of the surface (docs/method.md 7): that of the point's own facet and of those which
// continue it in the voxels around, trilinearly, each as much as it has area. No light comes in from another side.
#ifndef IRAD_SURFACE_LOOKUP_GLSL
#define IRAD_SURFACE_LOOKUP_GLSL
#include "gi/beside.h"
#include "gi/piece_cuts.h"
#include "shared/gi_params.h"

/// Facets around a point, and their weights, which sum to 1.
struct SurfaceTaps {
  uint facet[8];
  float weight[8];
};

/// The facet of a triangle's side (as Surfel::triangle) in one voxel at `p`; NO_FACET where the triangle has no piece
/// there, or no part of it that is seen from p.
uint facetInVoxel(SurfaceArrays surface, uint entry, vec3 p, uint side) {
  uint piece = pieceIn(piecesOf(surface, entry), side & ~SURFEL_BACK);
  if (piece == NO_PIECE) return NO_FACET;
  uint found = classAt(surface, piece, (side & SURFEL_BACK) != 0u, p);
  return found >= PIECE_UNKNOWN ? NO_FACET : firstFacet(entry) + found;
}

/// The facet on which `p` lies, a point of a triangle's side, in the voxel that holds p; NO_FACET where one has to search
/// for it (soughtFacet), as of one point in thirty thousand of simple scenes.
uint facetAt(SurfaceArrays surface, UintArray reverse, uvec3 dims, vec3 p, uint side) {
  side = firstInPlace(surface.corners, side & ~SURFEL_BACK) | (side & SURFEL_BACK);
  uint entry = entryOf(reverse, dims, ivec3(floor(p)));
  return entry == NO_FACET ? NO_FACET : facetInVoxel(surface, entry, p, side);
}

SurfaceTaps surfaceTaps(SurfaceArrays surface, UintArray reverse, UintArray facetVoxel, uvec3 dims, uint facet, vec3 p,
                        uint filter_) {
  SurfaceTaps taps;
  vec3 base = floor(p - 0.5);
  vec3 f = p - 0.5 - base;
  FacetLinks links = linksOf(surface, facet, facetVoxel.at[facet]);
  float total = 0.0;
  for (int i = 0; i < 8; ++i) {
    ivec3 corner = ivec3(i & 1, (i >> 1) & 1, i >> 2);
    ivec3 v = ivec3(base) + corner;
    ivec3 step_ = v - links.voxel + 1;
    taps.facet[i] = facet;
    taps.weight[i] = 0.0;
    if (filter_ == FILTER_NEAREST || any(lessThan(step_, ivec3(0))) || any(greaterThan(step_, ivec3(2)))) continue;
    uint linked = linkedFacet(surface, reverse, dims, links, uint(step_.x + 3 * step_.y + 9 * step_.z));
    if (linked == NO_FACET) continue;
    taps.facet[i] = linked;
    vec3 w = mix(1.0 - f, f, vec3(corner));
    taps.weight[i] = w.x * w.y * w.z * max(surface.area.at[taps.facet[i]], 1e-6);
    total += taps.weight[i];
  }
  if (total < 1e-12) {
    taps.weight[0] = total = 1.0;
    taps.facet[0] = facet;
    for (int i = 1; i < 8; ++i) taps.weight[i] = 0.0;
  }
  for (int i = 0; i < 8; ++i) taps.weight[i] /= total;
  return taps;
}

vec3 tapped(SurfaceTaps taps, Vec4Array values) {
  vec3 sum = vec3(0.0);
  for (int i = 0; i < 8; ++i)
    if (taps.weight[i] > 0.0) sum += taps.weight[i] * values.at[taps.facet[i]].xyz;
  return sum;
}

/// The same of values with a variance, w, and how little they say of the point between them: `spread`, by how much their
/// largest channels differ (1 - least / most), and `noise`, their standard deviation over their mean.
vec3 tapped(SurfaceTaps taps, Vec4Array values, out float spread, out float noise) {
  vec4 sum = vec4(0.0);
  float least = 1e30, most = 0.0;
  for (int i = 0; i < 8; ++i) {
    if (taps.weight[i] <= 0.0) continue;
    vec4 value = values.at[taps.facet[i]];
    sum += taps.weight[i] * value;
    float largest = max(value.r, max(value.g, value.b));
    least = min(least, largest);
    most = max(most, largest);
  }
  spread = most > 0.0 ? 1.0 - least / most : 0.0;
  noise = sum.w > 0.0 ? sqrt(sum.w) / length(sum.xyz) : 0.0;
  return sum.xyz;
}

#endif
