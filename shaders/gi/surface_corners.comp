// The triangles' corners in voxel units, as the voxelizer and the rays see them.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "gi/voxel_triangle.glsl"
#include "shared/surface.h"
layout(local_size_x = 64) in;
layout(push_constant, scalar) uniform Push { SurfaceCornersPush push; };

void main() {
  uint triangle = irad_index();
  if (triangle >= push.triangles) return;
  VoxelTriangle t = loadTriangle(push.scene, push.grid, triangle);
  GpuScene scene = push.scene.at[0];
  uint flags = scene.materials.at[scene.triangleMaterials.at[triangle]].flags;
  float back = (flags & MATERIAL_DOUBLE_SIDED) != 0u ? 1.0 : 0.0;
  float holes = (flags & MATERIAL_ALPHA_MASK) != 0u ? ((flags & MATERIAL_TRANSMISSIVE) != 0u ? 2.0 : 1.0) : 0.0;
  float repeats = push.hasRepeated != 0u ? float(push.repeated.at[triangle]) : 0.0;  // exact: MAX_TRIANGLES < 2^24
  for (uint i = 0u; i < 3u; ++i)
    push.corners.at[3u * triangle + i] = vec4(t.v[i], i == 0u ? back : (i == 1u ? holes : repeats));
}
