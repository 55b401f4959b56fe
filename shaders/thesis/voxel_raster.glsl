// Raster voxelization (T 5.1.2): a fragment is the voxel that the triangle's plane passes through at the pixel's centre
// (T eq. 14), which leaves pin-holes. The thesis lets the last writer win; here the same ordered key as in
// gi/voxelize.comp decides: all fragments lie on the middle line of their voxel.
#include "gi/voxel_material.glsl"
layout(push_constant, scalar) uniform Push { VoxelizePush push; };

/// Corner `i` in clip space. The viewport's y points up: negated here, so that the pixel's row is the voxel's.
vec4 flatCorner(VoxelTriangle t, uint i, uvec3 dims) {
  float scale = 2.0 / float(max(dims.x, max(dims.y, dims.z)));
  vec2 at = dominantLast(t.v[i], t.axis).xy * scale - 1.0;
  return vec4(at.x, -at.y, 0.0, 1.0);
}

void voxelFragment(FlatTriangle f, vec2 pixel) {
  uvec3 dims = push.grid.at[0].dims;
  uint triangle = f.triangle;
  uint d = f.axis & 3u;
  vec3 point = flatPoint(f, pixel);
  ivec3 cell = ivec3(floor(point));
  if (any(lessThan(cell, ivec3(0))) || any(greaterThanEqual(cell, ivec3(dims)))) return;
  uint voxel = voxelIndex(uvec3(cell), dims);
  // The point's distance in front of the voxel's centre along the triangle's facing.
  vec3 offset = dominantLast(point - vec3(cell) - 0.5, d);
  float depth = offset.z - dot(f.plane.xy, offset.xy);
  float columnArea = sqrt(1.0 + dot(f.plane.xy, f.plane.xy));
  float front = ((f.axis & RASTER_FACES_UP) != 0u ? depth : -depth) / columnArea;
  if (SAMPLES_TEXTURES != 0u) {
    uint flags = triangleFlags(push.scene, triangle);
    VoxelTriangle t = loadTriangle(push.scene, push.grid, triangle);
    if (masked(push.scene, t, triangle, flags, point)) return;
  }
  atomicMax(push.keys.at[voxel], middleKey(front, triangle));
}
