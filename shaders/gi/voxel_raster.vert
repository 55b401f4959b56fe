// Raster voxelization (T 5.1.2): projects the triangle along its dominant axis (T eq. 10-13), one pixel per voxel
// column. T does this in a geometry stage; a vertex that reads its whole triangle comes to the same without one.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "voxel_triangle.glsl"
layout(push_constant, scalar) uniform Push {
  VoxelizePush push;
};
layout(location = 0) flat out uvec2 triangleAxis;
layout(location = 1) flat out vec3 plane;  // depth = plane.z + plane.xy . (pixel - corner)
layout(location = 2) flat out vec2 corner;

void main() {
  uint triangle = uint(gl_VertexIndex) / 3u;
  VoxelTriangle t = loadTriangle(push.scene, push.grid, triangle);
  uvec3 dims = push.grid.at[0].dims;
  float scale = 2.0 / float(max(dims.x, max(dims.y, dims.z)));
  vec3 n = dominantLast(t.normal, t.axis);
  vec3 first = dominantLast(t.v[0], t.axis);
  triangleAxis = uvec2(triangle, t.axis | (n.z >= 0.0 ? RASTER_FACES_UP : 0u));
  plane = vec3(-n.xy / n.z, first.z);
  corner = first.xy;
  // The viewport's y points up: negated here, so that the pixel's row is the voxel's. A degenerate triangle ends in a
  // point.
  vec2 at = dominantLast(t.v[uint(gl_VertexIndex) % 3u], t.axis).xy * scale - 1.0;
  gl_Position = degenerate(t) ? vec4(0.0, 0.0, 0.0, 1.0) : vec4(at.x, -at.y, 0.0, 1.0);
}
