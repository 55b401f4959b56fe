// Which voxels a triangle has a piece in (docs/method.md 2), along the triangle's dominant axis. The edge tests in the
// projection and the plane's depth range over a column reject early (Schwarz and Seidel 2010, "Fast Parallel Surface and
// Solid Voxelization on GPUs"), clipping decides.
#ifndef IRAD_LIST_PIECES_H
#define IRAD_LIST_PIECES_H
#include "gi/voxel_clip.h"
#include "gi/voxel_triangle.h"
#include "shared/surface.h"
IRAD_BEGIN

/// Slack of the early tests, voxels: far above their rounding.
IRAD_CONST float EARLY_SLACK = 1e-3f;
/// A voxel is taken as larger by this on all sides, so that no ray finds a gap between two of them.
IRAD_CONST float OVERLAP = 1e-5f;

/// Counts or lists the pieces in the columns `first` to `last`. `lo`, `hi`: cellBounds, like them with the dominant axis
/// last.
IRAD_FN void listPieces(ListPiecesPush push, VoxelTriangle t, uint triangle, uvec3 dims, ivec3 lo, ivec3 hi,
                        ivec2 first, ivec2 last) {
  vec3 normal = dominantLast(t.normal, t.axis);
  vec3 corner[3];
  vec2 inward[3];  // edge functions e(p) = inward . (p - corner), >= 0 inside
  for (int i = 0; i < 3; ++i) corner[i] = dominantLast(t.v[i], t.axis);
  float orientation = normal.z >= 0.0f ? 1.0f : -1.0f;
  for (int i = 0; i < 3; ++i) {
    vec2 e = vec2(corner[(i + 1) % 3]) - vec2(corner[i]);
    inward[i] = vec2(-e.y, e.x) * orientation;
  }
  // The plane as depth over the projection: depth(p) = corner[0].z + slope . (p - corner[0]).
  vec2 slope = vec2(-normal.x, -normal.y) / normal.z;
  float depthLow = min(slope.x, 0.0f) + min(slope.y, 0.0f);  // over a column, from that of its corner
  float depthHigh = max(slope.x, 0.0f) + max(slope.y, 0.0f);
  bool oneCell = lo == hi;
  for (int y = first.y; y <= last.y; ++y) {
    for (int x = first.x; x <= last.x; ++x) {
      vec2 c = vec2(x, y);
      bool touches = true;
      for (int i = 0; i < 3; ++i) {
        float e = dot(inward[i], c - vec2(corner[i])) + max(inward[i].x, 0.0f) + max(inward[i].y, 0.0f);
        touches = touches && e >= -EARLY_SLACK * (abs(inward[i].x) + abs(inward[i].y));
      }
      if (!touches) continue;
      float depth = corner[0].z + dot(slope, c - vec2(corner[0]));
      int z0 = max(lo.z, int(floor(depth + depthLow - EARLY_SLACK)));
      int z1 = min(hi.z, int(floor(depth + depthHigh + EARLY_SLACK)));
      for (int z = z0; z <= z1; ++z) {
        vec3 base = vec3(x, y, z);
        if (!oneCell) {
          uint from;
          uint n = clipPolygon(corner[0] - base, corner[1] - base, corner[2] - base, OVERLAP, from);
          if (n == 0u) continue;
        }
        uint voxel = voxelIndex(uvec3(originalAxes(ivec3(x, y, z), t.axis)), dims);
        uint place = atomicAdd(push.counts.at[voxel], 1u);
        if (push.lists != 0u) push.pieces.at[place] = triangle;
      }
    }
  }
}

IRAD_END
#endif
