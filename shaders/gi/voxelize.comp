// Conservative voxelization, step 2 (METHOD section 2): one invocation per tile of columns along the triangle's dominant
// axis. A cell is covered when the triangle has a point in it: an edge test in the projection and the plane's depth range
// over the column reject early (Schwarz and Seidel 2010, "Fast Parallel Surface and Solid Voxelization on GPUs"), clipping
// decides and gives the area by which the key is ordered.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "voxel_triangle.glsl"
#include "voxel_clip.glsl"
#include "voxel_material.glsl"
layout(local_size_x = 64) in;
layout(push_constant, scalar) uniform Push { VoxelizePush push; };

/// Slack of the early tests, voxels: far above their rounding; clipping decides.
const float SLACK = 1e-3;

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
  VoxelTriangle t = loadTriangle(push.scene, push.grid, triangle);
  uint flags = triangleFlags(push.scene, triangle);
  uvec3 dims = push.grid.at[0].dims;
  uint voxels = push.grid.at[0].voxels;
  ivec3 lo, hi;
  cellBounds(t, dims, lo, hi);
  uint d = t.axis;
  uint u = (d + 1u) % 3u;
  uint w = (d + 2u) % 3u;
  uvec2 tiles;
  int edge = int(tileEdge(uvec2(hi[u] - lo[u] + 1, hi[w] - lo[w] + 1), tiles));
  uint local = tile - push.tileStart.at[triangle];
  ivec2 first = ivec2(lo[u], lo[w]) + ivec2(local % tiles.x, local / tiles.x) * edge;
  ivec2 last = min(first + edge - 1, ivec2(hi[u], hi[w]));

  // Edge functions e(p) = n . (p - v), >= 0 inside; the plane as depth over the projection.
  float orientation = t.normal[d] >= 0.0 ? 1.0 : -1.0;
  vec2 corner[3];
  vec2 inward[3];
  for (int i = 0; i < 3; ++i) corner[i] = vec2(t.v[i][u], t.v[i][w]);
  for (int i = 0; i < 3; ++i) {
    vec2 e = corner[(i + 1) % 3] - corner[i];
    inward[i] = vec2(-e.y, e.x) * orientation;
  }
  vec2 slope = -vec2(t.normal[u], t.normal[w]) / t.normal[d];
  float depth0 = t.v[0][d];
  float faceArea = length(t.normal) / abs(t.normal[d]);  // of the plane over one whole column
  float wholeArea = 0.5 * length(t.normal);
  bool oneCell = lo == hi;

  for (int y = first.y; y <= last.y; ++y) {
    for (int x = first.x; x <= last.x; ++x) {
      vec2 c = vec2(x, y);
      bool touches = true;
      bool covers = true;
      for (int i = 0; i < 3; ++i) {
        float e = dot(inward[i], c - corner[i]);
        float slack = SLACK * (abs(inward[i].x) + abs(inward[i].y));
        touches = touches && e + max(inward[i].x, 0.0) + max(inward[i].y, 0.0) >= -slack;
        covers = covers && e + min(inward[i].x, 0.0) + min(inward[i].y, 0.0) >= slack;
      }
      if (!touches) continue;
      float depth = depth0 + dot(slope, c - corner[0]);
      float nearest = depth + min(slope.x, 0.0) + min(slope.y, 0.0);
      float farthest = depth + max(slope.x, 0.0) + max(slope.y, 0.0);
      int z0 = max(lo[d], int(floor(nearest - SLACK)));
      int z1 = min(hi[d], int(floor(farthest + SLACK)));
      for (int z = z0; z <= z1; ++z) {
        ivec3 cell;
        cell[d] = z;
        cell[u] = x;
        cell[w] = y;
        uint voxel = voxelIndex(uvec3(cell), dims);
        if (push.slot == 1u) {
          uint winner = push.keys.at[voxel];
          if (winner == 0u) continue;  // cut away by its alpha mask
          if (!opposes(t.normal, flags, triangleNormal(push.scene, push.grid, keyTriangle(winner)))) continue;
        }
        vec3 corner3 = vec3(cell);
        vec3 centre = vec3(0.5);
        float area;
        if (oneCell) {
          area = wholeArea;
          centre = (t.v[0] + t.v[1] + t.v[2]) * (1.0 / 3.0) - corner3;
        } else if (covers && nearest >= float(z) && farthest <= float(z) + 1.0) {
          area = faceArea;
          centre[d] = 0.5 * (nearest + farthest) - float(z);
        } else {
          area = clipToCell(t.v[0] - corner3, t.v[1] - corner3, t.v[2] - corner3, centre);
          if (area < 0.0) continue;
        }
        if (masked(push.scene, t, triangle, flags, centre + corner3)) continue;
        atomicMax(push.keys.at[push.slot * voxels + voxel], voxelKey(area, triangle));
      }
    }
  }
}
