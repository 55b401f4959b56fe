// Which triangles have a piece in which voxel (docs/method.md 2): one invocation per tile of columns along the
// triangle's dominant axis. The edge tests in the projection and the plane's depth range over a column reject early
// (Schwarz and Seidel 2010, "Fast Parallel Surface and Solid Voxelization on GPUs"), clipping decides.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "gi/voxel_triangle.glsl"
#include "gi/voxel_clip.h"
#include "gi/triangle_hit.h"
#include "shared/surface.h"
layout(local_size_x = 64) in;
layout(push_constant, scalar) uniform Push { ListPiecesPush push; };

/// Slack of the early tests, voxels: far above their rounding.
const float SLACK = 1e-3;
/// A voxel is taken as larger by this on all sides, so that no ray finds a gap between two of them.
const float OVERLAP = 1e-5;

void main() {
  uint tile = irad_index();
  if (tile >= push.tileCount) return;
  tile += push.firstTile;
  // The last triangle that starts at or before this tile.
  uint triangle = push.firstTriangle;
  uint end = push.endTriangle;
  while (end - triangle > 1u) {
    uint middle = (triangle + end) / 2u;
    if (push.tileStart.at[middle] <= tile) triangle = middle;
    else end = middle;
  }
  // The area of a face that is there twice counts once.
  if (firstInPlace(push.corners, triangle) != triangle) return;
  VoxelTriangle t = loadTriangle(push.scene, push.grid, triangle);
  uvec3 dims = push.grid.at[0].dims;
  ivec3 lo, hi;
  cellBounds(t, dims, lo, hi);
  // From here on the dominant axis is z.
  vec3 normal = dominantLast(t.normal, t.axis);
  lo = dominantLast(lo, t.axis);
  hi = dominantLast(hi, t.axis);
  vec3 corner[3];
  vec2 inward[3];  // edge functions e(p) = inward . (p - corner), >= 0 inside
  for (int i = 0; i < 3; ++i) corner[i] = dominantLast(t.v[i], t.axis);
  float orientation = normal.z >= 0.0 ? 1.0 : -1.0;
  for (int i = 0; i < 3; ++i) {
    vec2 e = corner[(i + 1) % 3].xy - corner[i].xy;
    inward[i] = vec2(-e.y, e.x) * orientation;
  }
  // The plane as depth over the projection: depth(p) = corner[0].z + slope . (p - corner[0]).
  vec2 slope = -normal.xy / normal.z;
  float depthLow = min(slope.x, 0.0) + min(slope.y, 0.0);  // over a column, from that of its corner
  float depthHigh = max(slope.x, 0.0) + max(slope.y, 0.0);
  bool oneCell = lo == hi;

  uvec2 tiles;
  int edge = int(tileEdge(uvec2(hi.xy - lo.xy + 1), tiles));
  uint local = tile - push.tileStart.at[triangle];
  ivec2 first = lo.xy + ivec2(local % tiles.x, local / tiles.x) * edge;
  ivec2 last = min(first + edge - 1, hi.xy);
  for (int y = first.y; y <= last.y; ++y) {
    for (int x = first.x; x <= last.x; ++x) {
      vec2 c = vec2(x, y);
      bool touches = true;
      for (int i = 0; i < 3; ++i) {
        float e = dot(inward[i], c - corner[i].xy) + max(inward[i].x, 0.0) + max(inward[i].y, 0.0);
        touches = touches && e >= -SLACK * (abs(inward[i].x) + abs(inward[i].y));
      }
      if (!touches) continue;
      float depth = corner[0].z + dot(slope, c - corner[0].xy);
      int z0 = max(lo.z, int(floor(depth + depthLow - SLACK)));
      int z1 = min(hi.z, int(floor(depth + depthHigh + SLACK)));
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
