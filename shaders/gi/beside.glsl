// Which points of different voxels lie on the same side of the surface (gi/seen_in_voxel.glsl says it of one voxel).
#ifndef IRAD_BESIDE_GLSL
#define IRAD_BESIDE_GLSL
#include "gi/seen_in_voxel.glsl"
#include "gi/surface_point.glsl"

VoxelPieces piecesOf(SurfaceArrays surface, uint entry) {
  uint first = firstFacet(entry);
  return voxelPieces(surface.corners, surface.pieces, surface.firstPiece.at[first],
                     surface.firstPiece.at[first + facetsOf(entry)]);
}

uint entryOf(UintArray reverse, uvec3 dims, ivec3 v) {
  if (any(lessThan(v, ivec3(0))) || any(greaterThanEqual(v, ivec3(dims)))) return NO_FACET;
  return reverse.at[voxelIndex(uvec3(v), dims)];
}

/// Whether the segment crosses no triangle but two, in any of the voxels that it may pass.
bool clearBetween(SurfaceArrays surface, UintArray reverse, uvec3 dims, vec3 a, vec3 b, uint except1, uint except2) {
  ivec3 lo = ivec3(floor(min(a, b))), hi = ivec3(floor(max(a, b)));
  for (int z = lo.z; z <= hi.z; ++z)
    for (int y = lo.y; y <= hi.y; ++y)
      for (int x = lo.x; x <= hi.x; ++x) {
        uint entry = entryOf(reverse, dims, ivec3(x, y, z));
        if (entry != NO_FACET && !clearInVoxel(piecesOf(surface, entry), a, b, except1, except2)) return false;
      }
  return true;
}

/// How far above a surfel ways from it begin, in the voxel that holds it.
float liftOf(SurfaceArrays surface, UintArray reverse, uvec3 dims, SurfelPoint p) {
  uint entry = entryOf(reverse, dims, ivec3(floor(p.position)));
  return entry == NO_FACET ? ABOVE_SURFACE : clearAbove(piecesOf(surface, entry), p.position, p.facing, p.triangle);
}

bool continues(SurfaceArrays surface, UintArray reverse, uvec3 dims, SurfelPoint a, SurfelPoint b) {
  float bulge;
  if (!mayBeSameSide(a.position, a.facing, b.position, b.facing, bulge)) return false;
  vec3 from = a.position + a.facing * liftOf(surface, reverse, dims, a);
  vec3 to = b.position + b.facing * liftOf(surface, reverse, dims, b);
  if (bulge > ABOVE_SURFACE) {
    vec3 fromHigh = from + a.facing * bulge, toHigh = to + b.facing * bulge;
    if (!clearBetween(surface, reverse, dims, from, fromHigh, a.triangle, b.triangle) ||
        !clearBetween(surface, reverse, dims, to, toHigh, a.triangle, b.triangle))
      return false;
    from = fromHigh;
    to = toHigh;
  }
  return clearBetween(surface, reverse, dims, from, to, a.triangle, b.triangle);
}

/// The facet of the surfel nearest to a point of the surface, on its side, in the 27 voxels around; or NO_FACET.
uint facetBeside(SurfaceArrays surface, UintArray reverse, uvec3 dims, SurfelPoint p) {
  uint found = NO_FACET;
  float nearest = 1e30;
  for (int i = 0; i < 27; ++i) {
    uint entry = entryOf(reverse, dims, ivec3(floor(p.position)) + ivec3(i % 3, (i / 3) % 3, i / 9) - 1);
    if (entry == NO_FACET) continue;
    uint end = (firstFacet(entry) + facetsOf(entry)) * FACET_SURFELS;
    for (uint k = firstFacet(entry) * FACET_SURFELS; k < end; ++k) {
      SurfelPoint s = surfelOf(surface, k / FACET_SURFELS, k % FACET_SURFELS);
      vec3 d = s.position - p.position;
      if (dot(d, d) >= nearest || !continues(surface, reverse, dims, p, s)) continue;
      nearest = dot(d, d);
      found = k / FACET_SURFELS;
    }
  }
  return found;
}

#endif
