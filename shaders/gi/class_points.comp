// Which points of a voxel belong to one facet: those on the same side of the surface as the first of them
// (docs/method.md 4). One invocation per voxel; gi/class_crowd.comp takes voxels with many points.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "gi/class_points.glsl"
layout(local_size_x = 64) in;

void main() {
  uint voxel = irad_index();
  if (voxel >= push.count) return;
  SurfaceArrays surface = push.surface.at[0];
  vec3 cell = vec3(unpackVoxel(push.solid.at[voxel]));
  VoxelPieces pieces =
      voxelPieces(surface.corners, surface.pieces, surface.boxes, cell, push.firstPiece.at[voxel], push.firstPiece.at[voxel + 1u]);
  uint first = push.firstPoint.at[pieces.first], end = push.firstPoint.at[pieces.end];
  if (end - first > CROWD) {
    bool few = end - first <= push.few;
    uint place = atomicAdd(push.crowdCounts.at[few ? 0u : 1u], 1u);
    push.crowds.at[few ? place : push.count - 1u - place] = voxel;
    return;
  }
  uint classes = 0u;
  // What is too small to be a facet joins one; where there is nothing else, it is one.
  for (uint small = 0u; small < 2u; ++small) {
    for (uint i = first; i < end; ++i) {
      if (push.classes.at[i] != NO_CLASS) continue;
      ClassPoint p = classPoint(surface, i);
      if ((p.area < LEAST_FACET) != (small == 1u)) continue;
      uint found = NO_CLASS;
      for (uint j = first; j < end && found == NO_CLASS; ++j) {
        uint other = push.classes.at[j];
        if ((other & CLASS_LEADER) != 0u && sameSide(pieces, classPoint(surface, j).point, p.point)) found = other & ~CLASS_LEADER;
      }
      if (found == NO_CLASS && (small == 0u ? classes <= LAST_CLASS : classes == 0u)) found = CLASS_LEADER | classes++;
      push.classes.at[i] = found;
    }
  }
  // Every voxel has a facet: its pieces end where the next one's begin.
  if (classes == 0u) push.classes.at[first] = CLASS_LEADER;
  push.facets.at[voxel] = max(classes, 1u);
  push.wide.at[voxel] = 0u;  // a piece has a point at least
}
