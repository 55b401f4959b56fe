// Raster voxelization by kernels (shaders/raster/raster.glsl).
#version 460
#extension GL_GOOGLE_include_directive : require
#include "gi/voxel_triangle.glsl"

#include "thesis/voxel_raster.glsl"
#include "raster/raster.glsl"

FlatTriangle current = FlatTriangle(0xFFFFFFFFu, 0u, vec3(0.0), vec2(0.0));

RasterJob rasterJob() {
  uvec3 dims = push.grid.at[0].dims;
  return RasterJob(RasterQueue(push.tileStart), SAMPLES_TEXTURES, push.tileCount,
                   uvec2(max(dims.x, max(dims.y, dims.z))), push.firstTriangle, push.endTriangle);
}

bool rasterCorners(uint triangle, out vec4 corners[3], out bool cull) {
  if (SAMPLES_TEXTURES == 0u && (triangleFlags(push.scene, triangle) & MATERIAL_ALPHA_MASK) != 0u) return false;
  VoxelTriangle t = loadTriangle(push.scene, push.grid, triangle);
  current = flatTriangle(t, triangle);
  for (uint i = 0u; i < 3u; ++i) corners[i] = flatCorner(t, i, push.grid.at[0].dims);
  cull = false;
  return !degenerate(t);
}

void rasterBegin(uint triangle) {
  if (triangle != current.triangle)
    current = flatTriangle(loadTriangle(push.scene, push.grid, triangle), triangle);
}

void rasterPixel(uint triangle, ivec2 pixel, float depth) { voxelFragment(current, vec2(pixel) + 0.5); }
