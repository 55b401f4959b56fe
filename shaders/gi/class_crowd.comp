// As gi/class_points.comp, for voxels with many points: one workgroup each.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "gi/class_point.h"
layout(local_size_x = 64) in;
layout(push_constant, scalar) uniform Push { ClassPointsPush push; };

shared uint next;
shared uint leaders[LAST_CLASS + 1u];
/// By blocks of the voxel's points those that belong to no class yet, and of these those that may belong to the
/// leader's: far fewer, so that all invocations take turns at them.
const uint BLOCK = 256u;
shared uint open[BLOCK], likely[BLOCK];
shared uint opened, likelies;

void main() {
  if (irad_workgroup() >= push.count) return;
  uint voxel = push.crowds.at[irad_workgroup()];
  uint me = gl_LocalInvocationID.x;
  SurfaceArrays surface = push.surface.at[0];
  VoxelPieces pieces = piecesOfSolid(push, surface, voxel);
  uint first = push.firstPoint.at[pieces.first], end = push.firstPoint.at[pieces.end];
  uint stride = (end - first + MOST_COMPARED - 1u) / MOST_COMPARED;
  uint step_ = stride * gl_WorkGroupSize.x;
  uint classes = 0u, from = first;
  float least = LEAST_FACET;
  while (classes <= LAST_CLASS) {
    // The first that belongs to none yet leads the next class.
    if (me == 0u) next = end;
    barrier();
    bool any = false;
    for (uint i = from + me * stride; i < end && !any; i += step_) {
      any = push.classes.at[i] == NO_CLASS && classPoint(push, surface, i).area >= least;
      if (any) atomicMin(next, i);
    }
    barrier();
    uint lead = next;
    barrier();
    if (lead == end) {
      // Where nothing is large enough, what there is makes facets.
      if (classes > 0u || least == 0.0) break;
      least = 0.0;
      from = first;
      continue;
    }
    from = lead;  // none before it may lead
    if (me == 0u) leaders[classes] = lead;
    SidePoint leader = classPoint(push, surface, lead).point;
    for (uint block = first; block < end; block += BLOCK * stride) {
      if (me == 0u) opened = likelies = 0u;
      barrier();
      uint endBlock = min(end, block + BLOCK * stride);
      for (uint i = block + me * stride; i < endBlock; i += step_)
        if (push.classes.at[i] == NO_CLASS && i != lead) open[atomicAdd(opened, 1u)] = i;
      barrier();
      for (uint q = me; q < opened; q += gl_WorkGroupSize.x)
        if (mayContinue(leader.at, classPoint(push, surface, open[q]).point.at)) likely[atomicAdd(likelies, 1u)] = open[q];
      barrier();
      for (uint q = me; q < likelies; q += gl_WorkGroupSize.x)
        if (sameSide(pieces, leader, classPoint(push, surface, likely[q]).point)) push.classes.at[likely[q]] = classes;
      barrier();
    }
    if (me == 0u) push.classes.at[lead] = classes | CLASS_LEADER;
    memoryBarrierBuffer();
    barrier();
    ++classes;
  }
  if (me == 0u) {
    // Every voxel has a facet: its pieces end where the next one's begin.
    if (classes == 0u) push.classes.at[first] = CLASS_LEADER;
    push.facets.at[voxel] = max(classes, 1u);
    push.wide.at[voxel] = pieces.end - pieces.first > MOST_NARROW ? max(classes, 1u) : 0u;
  }
  memoryBarrierBuffer();
  barrier();
  // Neighbours in the list are neighbours in the mesh: the others go with the next one that faces their way.
  for (uint i = first + me; stride > 1u && i < end; i += gl_WorkGroupSize.x) {
    if ((i - first) % stride == 0u || push.classes.at[i] != NO_CLASS) continue;
    vec3 facing = classPoint(push, surface, i).point.at.facing;
    uint compared = i - (i - first) % stride;
    for (uint k = 0u; k < 8u; ++k) {
      uint near = compared + (k % 2u == 0u ? -(k / 2u) * stride : (k / 2u + 1u) * stride);
      if (near < first || near >= end) continue;
      uint found = push.classes.at[near];
      if (found == NO_CLASS || isOfPart(found)) continue;
      if (!facesAlike(classPoint(push, surface, near).point.at.facing, facing)) continue;
      push.classes.at[i] = found & ~CLASS_LEADER;
      break;
    }
  }
  // What is left of a voxel that would have more facets than there may be: where all pieces are looked at, it has none,
  // for it is known to be apart from the others; else it goes with those that face its way most.
  if (classes <= LAST_CLASS || pieces.endLarge == pieces.end) return;
  for (uint i = first + me; i < end; i += gl_WorkGroupSize.x) {
    if (push.classes.at[i] != NO_CLASS) continue;
    vec3 facing = classPoint(push, surface, i).point.at.facing;
    float most = 0.0;
    for (uint k = 0u; k < classes; ++k) {
      float alike = preciseDot(classPoint(push, surface, leaders[k]).point.at.facing, facing);
      if (alike <= most) continue;
      most = alike;
      push.classes.at[i] = k;
    }
  }
}
