// As gi/class_points.comp, for voxels with many points: one workgroup each.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "gi/class_points.glsl"
layout(local_size_x = 64) in;

shared uint next;

void main() {
  uint voxel = irad_workgroup();
  if (voxel >= push.count) return;
  uint me = gl_LocalInvocationID.x;
  SurfaceArrays surface = push.surface.at[0];
  VoxelPieces pieces =
      voxelPieces(surface.corners, surface.pieces, push.firstPiece.at[voxel], push.firstPiece.at[voxel + 1u]);
  uint first = push.firstPoint.at[pieces.first], end = push.firstPoint.at[pieces.end];
  if (end - first <= CROWD) return;
  uint classes = 0u;
  float least = LEAST_FACET;
  while (classes <= LAST_CLASS) {
    // The first that belongs to none yet leads the next class.
    if (me == 0u) next = end;
    barrier();
    bool any = false;
    for (uint i = first + me; i < end && !any; i += gl_WorkGroupSize.x) {
      any = push.classes.at[i] == NO_CLASS && classPoint(surface, i).area >= least;
      if (any) atomicMin(next, i);
    }
    barrier();
    uint lead = next;
    barrier();
    if (lead == end) {
      // Where nothing is large enough, what there is makes facets.
      if (classes > 0u || least == 0.0) break;
      least = 0.0;
      continue;
    }
    ClassPoint leader = classPoint(surface, lead);
    for (uint i = first + me; i < end; i += gl_WorkGroupSize.x)
      if (push.classes.at[i] == NO_CLASS && (i == lead || together(pieces, leader, classPoint(surface, i))))
        push.classes.at[i] = classes | (i == lead ? CLASS_LEADER : 0u);
    ++classes;
  }
  if (me == 0u) push.facets.at[voxel] = classes;
}
