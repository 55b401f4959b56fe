// Raster voxelization (T 5.1.2): projects the triangle along its dominant axis (T eq. 10-13), one pixel per voxel
// column. The thesis does this in a geometry stage; with vertices that read their whole triangle none is needed.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "gi/voxel_triangle.glsl"

#include "thesis/voxel_raster.glsl"
layout(location = 0) flat out uvec2 triangleAxis;
layout(location = 1) flat out vec3 plane;
layout(location = 2) flat out vec2 corner;

void main() {
  uint triangle = uint(gl_VertexIndex) / 3u;
  VoxelTriangle t = loadTriangle(push.scene, push.grid, triangle);
  FlatTriangle f = flatTriangle(t, triangle);
  triangleAxis = uvec2(f.triangle, f.axis);
  plane = f.plane;
  corner = f.corner;
  // A degenerate triangle ends in a point.
  vec4 clip = flatCorner(t, uint(gl_VertexIndex) % 3u, push.grid.at[0].dims);
  gl_Position = degenerate(t) ? vec4(0.0, 0.0, 0.0, 1.0) : clip;
}
