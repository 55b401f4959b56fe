// Which points of a voxel belong to one facet: those on the same side of the surface as the first of them
// (docs/method.md 4). One invocation per voxel; gi/class_crowd.comp takes voxels with many points.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "gi/class_point.h"
layout(local_size_x = 64) in;
layout(push_constant, scalar) uniform Push { ClassPointsPush push; };

void main() {
  uint voxel = irad_index();
  if (voxel >= push.count) return;
  SurfaceArrays surface = push.surface.at[0];
  VoxelPieces pieces = piecesOfSolid(push, surface, voxel);
  uint first = push.firstPoint.at[pieces.first], end = push.firstPoint.at[pieces.end];
  if (end - first > CROWD) {
    push.crowds.at[atomicAdd(push.crowdCount.at[0], 1u)] = voxel;
    return;
  }
  uint classes = 0u;
  // What is too small to be a facet joins one; where there is nothing else, it is one.
  for (uint small = 0u; small < 2u; ++small) {
    for (uint i = first; i < end; ++i) {
      if (push.classes.at[i] != NO_CLASS) continue;
      ClassPoint p = classPoint(push, surface, i);
      if ((p.area < LEAST_FACET) != (small == 1u)) continue;
      uint found = NO_CLASS;
      for (uint j = first; j < end && found == NO_CLASS; ++j) {
        uint other = push.classes.at[j];
        if ((other & CLASS_LEADER) != 0u && sameSide(pieces, classPoint(push, surface, j).point, p.point)) found = other & ~CLASS_LEADER;
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
