// Where a material's alpha mask leaves a piece, or a blended one's screen: a bit for each of its squares (docs/method.md
// 4). One dispatch per textured material, whose set 1 is bound, and one for all others.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "gi/voxel_triangle.glsl"
#include "gi/voxel_material.glsl"
#include "shared/glass.h"
#include "shared/surface.h"
layout(local_size_x = 64) in;
layout(push_constant, scalar) uniform Push { PieceMaskPush push; };

void main() {
  uint index = irad_index();
  if (index >= push.count) return;
  uint piece = push.order.at[push.first + index];
  uint triangle = push.pieces.at[piece] & ~PIECE_SMALL;
  VoxelTriangle t = loadTriangle(push.scene, push.grid, triangle);
  uint packedVoxel = push.solid.at[push.pieceVoxel.at[piece]];
  vec3 cell = vec3(unpackVoxel(packedVoxel));
  // Filtered over a square.
  MaterialTriangle m = materialTriangle(push.scene, triangle, areaOf(t) * float(MASK_EDGE * MASK_EDGE));
  bool screen = (m.flags & MATERIAL_BLEND) != 0u, tinted = isPane(m);
  uint seed = hashUint(packedVoxel ^ hashUint(triangle));
  uint left = 0u, right = 0u;
  uvec3 closedLeft = uvec3(0u), closedRight = uvec3(0u);  // squares closed to each channel
  for (uint bit = 0u; bit < MASK_EDGE * MASK_EDGE; ++bit) {
    vec3 weight = barycentrics(t, cell + maskPoint(t.normal, t.v[0] - cell, bit));
    if (tinted) {
      // Those that are there are closed to all; thresholds are the same, so that channels have squares in common.
      vec3 kept = 1.0 - panePoint(m, weight).passes;
      bvec3 closed = greaterThan(kept, vec3(screenThreshold(bit, seed)));
      uvec3 set = mix(uvec3(0u), uvec3(1u << (bit & 31u)), closed);
      if (bit < 32u) closedLeft |= set;
      else closedRight |= set;
      if (!all(closed)) continue;
    } else if (screen ? baseColorAt(m, weight).a <= screenThreshold(bit, seed) : cutAway(m, weight)) {
      continue;
    }
    if (bit < 32u) left |= 1u << bit;
    else right |= 1u << (bit - 32u);
  }
  uint place = push.firstCut.at[piece];
  push.cuts.at[place] = CUT_MASKED | (screen ? CUT_SCREEN : 0u) | (tinted ? CUT_TINTED : 0u);
  for (uint c = 0u; tinted && c < 3u; ++c) {
    push.cuts.at[place + 3u + 2u * c] = closedLeft[c];
    push.cuts.at[place + 4u + 2u * c] = closedRight[c];
  }
  push.cuts.at[place + 1u] = left;
  push.cuts.at[place + 2u] = right;
}
