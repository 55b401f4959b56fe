// Triangles of the scene through a projection; masked ones look at their texture.
#include "forward/material.glsl"
#include "forward/project.glsl"
#include "raster/corner_weights.glsl"
#include "raster/raster.glsl"

layout(constant_id = RASTER_MASKED) const bool MASKED = false;
layout(push_constant, scalar) uniform PushBlock { RasterPush push; };

vec4 corner[3];  ///< of the current triangle, of a masked material

RasterJob rasterJob() { return RasterJob(push.queue, push.pieces, push.size, push.first, push.end); }

void projectCorners(uint triangle, out vec4 corners[3]) {
  GpuScene scene = push.scene.at[0];
  mat4 projection = push.projection.at[0].matrix;
  for (uint i = 0u; i < 3u; ++i)
    corners[i] = project(projection, scene.positions.at[scene.indices.at[3u * triangle + i]]);
}

bool rasterCorners(uint triangle, out vec4 corners[3], out bool cull) {
  GpuScene scene = push.scene.at[0];
  uint flags = scene.materials.at[scene.triangleMaterials.at[triangle]].flags;
  cull = push.cull != 0u && (flags & MATERIAL_DOUBLE_SIDED) == 0u;
  if (push.skipMasked != 0u && (flags & MATERIAL_ALPHA_MASK) != 0u) return false;
  projectCorners(triangle, corners);
  return true;
}

void rasterBegin(uint triangle) {
  if (MASKED) projectCorners(triangle, corner);
}

/// Whether the material's alpha cuts the pixel out.
bool cutOut(uint triangle, ivec2 pixel) {
  if (!MASKED) return false;
  GpuScene scene = push.scene.at[0];
  GpuMaterial m = scene.materials.at[scene.triangleMaterials.at[triangle]];
  vec4 uv[3];
  float alpha[3];
  for (uint i = 0u; i < 3u; ++i) {
    uint vertex = scene.indices.at[3u * triangle + i];
    uv[i] = vec4(scene.uv0.at[vertex], scene.uv1.at[vertex]);
    alpha[i] = scene.colors.at[vertex].w;
  }
  PixelWeights w = pixelWeights(corner, pixel, push.size);
  vec4 here = weighted(uv[0], uv[1], uv[2], w.here);
  vec4 first = weighted(uv[0], uv[1], uv[2], w.first);
  uvDx = weighted(uv[0], uv[1], uv[2], w.right) - first;
  uvDy = weighted(uv[0], uv[1], uv[2], w.below) - first;
  float tint = alpha[0] + (alpha[1] - alpha[0]) * w.here.y + (alpha[2] - alpha[0]) * w.here.z;
  return materialCutOut(m, materialBaseColor(m, here, vec4(1.0, 1.0, 1.0, tint)).a);
}
