// Raster voxelization by the graphics pipeline.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "gi/voxel_triangle.glsl"

#include "thesis/voxel_raster.glsl"
layout(location = 0) flat in uvec2 triangleAxis;
layout(location = 1) flat in vec3 plane;
layout(location = 2) flat in vec2 corner;

void main() {
  voxelFragment(FlatTriangle(triangleAxis.x, triangleAxis.y, plane, corner), floor(gl_FragCoord.xy) + 0.5);
}
