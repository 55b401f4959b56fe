// Raster voxelization (T 5.1.2): a fragment is the voxel that the triangle's plane passes through at the pixel's centre
// (T eq. 14), which leaves pin-holes. The thesis lets the last writer win; here the same ordered key as in
// gi/voxelize.comp decides: all fragments lie on the middle line of their voxel.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "voxel_triangle.glsl"

#include "voxel_material.glsl"
layout(push_constant, scalar) uniform Push { VoxelizePush push; };
layout(location = 0) flat in uvec2 triangleAxis;
layout(location = 1) flat in vec3 plane;
layout(location = 2) flat in vec2 corner;

void main() {
  uvec3 dims = push.grid.at[0].dims;
  uint triangle = triangleAxis.x;
  uint d = triangleAxis.y & 3u;
  vec2 pixel = floor(gl_FragCoord.xy) + 0.5;
  vec3 point = originalAxes(vec3(pixel, plane.z + dot(plane.xy, pixel - corner)), d);
  ivec3 cell = ivec3(floor(point));
  if (any(lessThan(cell, ivec3(0))) || any(greaterThanEqual(cell, ivec3(dims)))) return;
  uint voxel = voxelIndex(uvec3(cell), dims);
  // The point's distance in front of the voxel's centre along the triangle's facing.
  vec3 offset = dominantLast(point - vec3(cell) - 0.5, d);
  float depth = offset.z - dot(plane.xy, offset.xy);
  float columnArea = sqrt(1.0 + dot(plane.xy, plane.xy));
  float front = ((triangleAxis.y & RASTER_FACES_UP) != 0u ? depth : -depth) / columnArea;
  uint place = push.slot * push.grid.at[0].voxels + voxel;
  bool back = false;
  float cosine = -1.0;
  // One facet of an opaque material needs nothing of the triangle itself.
  if (push.slots > 1u || SAMPLES_TEXTURES != 0u) {
    uint flags = triangleFlags(push.scene, triangle);
    VoxelTriangle t = loadTriangle(push.scene, push.grid, triangle);
    if (push.slot == 1u) {
      uint winner = push.keys.at[voxel];
      if (winner == 0u) return;
      cosine = secondCosine(t.normal, flags, winnerFacing(push.scene, push.grid, winner), back);
      if (cosine >= ELSEWHERE_COSINE) return;
    }
    if (masked(push.scene, t, triangle, flags, point)) return;
    if (push.slot > 1u && push.keys.at[voxel] == 0u) return;
    if (push.slot != 1u && push.slots > 1u && (flags & MATERIAL_DOUBLE_SIDED) != 0u &&
        (push.slot == 0u || !recorded(push, voxel, -t.normal, point)))
      atomicMax(push.keys.at[place], middleKey(-front, true, triangle));
    if (push.slot > 1u && recorded(push, voxel, t.normal, point)) return;
  }
  uint key = middleKey(back ? -front : front, back, triangle);
  atomicMax(push.keys.at[place], push.slot == 1u ? secondKey(key, cosine < OPPOSED_COSINE) : key);
}
