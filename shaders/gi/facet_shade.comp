// Facets are sampled at the centre of the part of the winning triangle that lies in the voxel.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "facet_shade.glsl"
#include "voxel_clip.h"

vec3 sampledAt(VoxelTriangle t, uint triangle, vec3 cell) {
  vec3 centre;
  clipToCell(t.v[0] - cell, t.v[1] - cell, t.v[2] - cell, centre);
  return centre;
}
