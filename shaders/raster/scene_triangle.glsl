// Triangles of the scene through a projection; masked ones look at their texture.
#include "forward/material.glsl"
#include "forward/project.glsl"
#include "raster/corner_weights.glsl"
#include "raster/raster.glsl"
#include "shared/glass.h"

layout(constant_id = RASTER_MASKED) const bool MASKED = false;
layout(push_constant, scalar) uniform PushBlock { RasterPush push; };

/// The current triangle, of a masked material: what its pixels' alpha depends on.
struct MaskedTriangle {
  vec4 corner[3];
  vec4 uv[3];
  vec4 tint[3];  ///< the corners' colours
  GpuMaterial material;
};
MaskedTriangle current;

RasterJob rasterJob() { return RasterJob(push.queue, MASKED ? 1u : 0u, push.pieces, push.size, push.first, push.end); }

void projectCorners(uint triangle, out vec4 corners[3]) {
  GpuScene scene = push.scene.at[0];
  mat4 projection = push.projection.at[0].matrix;
  for (uint i = 0u; i < 3u; ++i)
    corners[i] = project(projection, scene.positions.at[scene.indices.at[3u * triangle + i]]);
}

void rasterBegin(uint triangle) {
  if (!MASKED) return;
  GpuScene scene = push.scene.at[0];
  projectCorners(triangle, current.corner);
  current.material = scene.materials.at[scene.triangleMaterials.at[triangle]];
  for (uint i = 0u; i < 3u; ++i) {
    uint vertex = scene.indices.at[3u * triangle + i];
    current.uv[i] = vec4(scene.uv0.at[vertex], scene.uv1.at[vertex]);
    current.tint[i] = scene.colors.at[vertex];
  }
}

bool rasterCorners(uint triangle, out vec4 corners[3], out bool cull) {
  GpuScene scene = push.scene.at[0];
  uint flags = scene.materials.at[scene.triangleMaterials.at[triangle]].flags;
  cull = push.cull != 0u && (flags & MATERIAL_DOUBLE_SIDED) == 0u;
  if (push.skipMasked != 0u && (flags & MATERIAL_ALPHA_MASK) != 0u) return false;
  projectCorners(triangle, corners);
  return true;
}

/// Whether the material's alpha cuts the pixel out; `threshold`: as materialCutOut; `channel`: as materialCover.
bool cutOut(ivec2 pixel, float threshold, uint channel) {
  PixelWeights w = pixelWeights(current.corner, pixel, push.size);
  vec4 uv = weighted(current.uv[0], current.uv[1], current.uv[2], w.here);
  vec4 first = weighted(current.uv[0], current.uv[1], current.uv[2], w.first);
  uvDx = weighted(current.uv[0], current.uv[1], current.uv[2], w.right) - first;
  uvDy = weighted(current.uv[0], current.uv[1], current.uv[2], w.below) - first;
  vec4 tint = current.tint[0] + (current.tint[1] - current.tint[0]) * w.here.y +
              (current.tint[2] - current.tint[0]) * w.here.z;
  return materialCutOut(current.material,
                        materialCover(current.material, uv, materialBaseColor(current.material, uv, tint), channel),
                        threshold);
}
