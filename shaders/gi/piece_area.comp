// The area of every piece.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "gi/triangle_hit.glsl"
#include "gi/voxel_clip.glsl"
#include "shared/surface.h"
layout(local_size_x = 64) in;
layout(push_constant, scalar) uniform Push { PieceAreaPush push; };

void main() {
  uint i = irad_index();
  if (i >= push.count) return;
  vec3 cell = vec3(unpackVoxel(push.pieceVoxel.at[i]));
  Triangle t = triangleAt(push.corners, push.pieces.at[i]);
  vec3 centre;
  float area = clipToCell(t.a - cell, t.b - cell, t.c - cell, centre);
  push.area.at[i] = max(area, 0.0);
}
