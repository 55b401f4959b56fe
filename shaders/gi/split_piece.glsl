// A piece with a wall on it has parts that belong to several facets of its voxel.
#ifndef IRAD_SPLIT_PIECE_GLSL
#define IRAD_SPLIT_PIECE_GLSL
#include "gi/seen_in_voxel.glsl"
#include "gi/surface_point.glsl"

VoxelPieces piecesOf(SurfaceArrays surface, uint entry) {
  uint first = firstFacet(entry);
  return VoxelPieces(surface.corners, surface.pieces, surface.firstPiece.at[first],
                     surface.firstPiece.at[first + facetsOf(entry)]);
}

/// The facet of a piece's side (as Surfel::triangle) at a point of it: that of the nearest surfel which is seen from
/// there, or NO_FACET.
uint splitFacet(SurfaceArrays surface, uint entry, uint side, vec3 point) {
  VoxelPieces voxel = piecesOf(surface, entry);
  uint first = firstFacet(entry) * FACET_SURFELS, end = first + facetsOf(entry) * FACET_SURFELS;
  uint facet = NO_FACET;
  float nearest = 1e30;
  for (uint i = first; i < end; ++i) {
    Surfel s = surface.surfels.at[i];
    if (s.triangle != side) continue;
    SurfelPoint p = surfelOf(surface, s);
    vec3 d = p.position - point;
    if (dot(d, d) >= nearest || !sameSide(voxel, point, p.facing, p.triangle, p.position, p.facing, p.triangle)) continue;
    nearest = dot(d, d);
    facet = i / FACET_SURFELS;
  }
  return facet;
}

#endif
