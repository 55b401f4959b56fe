// After raster voxelization facets are sampled where their fragment was, as in T 5.1. (A shader of its own, because the
// one that clips holds polygons in shared memory, so that few of its workgroups run at a time.)
#version 460
#extension GL_GOOGLE_include_directive : require
#include "gi/facet_shade.glsl"

vec3 sampledAt(VoxelTriangle t, uint triangle, vec3 cell) {
  return flatPoint(flatTriangle(t, triangle), dominantLast(cell, t.axis).xy + 0.5) - cell;
}
