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

/// The facet at a point of a triangle's side in a voxel: that of the nearest surfel which lies on the same side, or
/// NO_FACET.
uint nearestOnSide(SurfaceArrays surface, uint entry, uint triangle, vec3 facing, vec3 point) {
  VoxelPieces voxel = piecesOf(surface, entry);
  uint first = firstFacet(entry) * FACET_SURFELS, end = first + facetsOf(entry) * FACET_SURFELS;
  uint facet = NO_FACET;
  float nearest = 1e30;
  for (uint i = first; i < end; ++i) {
    SurfelPoint p = surfelOf(surface, surface.surfels.at[i]);
    vec3 d = p.position - point;
    if (dot(d, d) >= nearest || !sameSide(voxel, point, facing, triangle, p.position, p.facing, p.triangle)) continue;
    nearest = dot(d, d);
    facet = i / FACET_SURFELS;
  }
  return facet;
}

#endif
