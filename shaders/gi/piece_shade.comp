// Albedo = base colour x (1 - metallic) clamped to [0, .98] and emitted exitance of each piece, at its middle
// (docs/method.md 1-2). One dispatch per textured material, whose set 1 is bound, and one for all pieces that sample no
// texture.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "gi/voxel_triangle.glsl"
#include "gi/voxel_material.glsl"
#include "gi/voxel_clip.glsl"
#include "shared/surface.h"
layout(local_size_x = 64) in;
layout(push_constant, scalar) uniform Push { PieceShadePush push; };

void main() {
  uint index = irad_index();
  if (index >= push.count) return;
  uint piece = push.order.at[push.first + index];
  uint triangle = push.pieces.at[piece] & ~PIECE_SMALL;
  VoxelTriangle t = loadTriangle(push.scene, push.grid, triangle);
  vec3 cell = vec3(unpackVoxel(push.solid.at[push.pieceVoxel.at[piece]]));
  vec3 centre;
  clipToCell(t.v[0] - cell, t.v[1] - cell, t.v[2] - cell, centre);
  MaterialPoint p = materialPoint(push.scene, t, triangle, centre + cell);
  bool clamped;
  vec3 albedo = albedoAt(push.scene, p, clamped);
  if (clamped) atomicAdd(push.clamped.at[0], 1u);
  push.albedo.at[piece] = albedo;
  if (push.hasEmission != 0u) push.emission.at[piece] = exitanceOf(emittedRadianceAt(push.scene, p));
}
