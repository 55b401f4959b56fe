// Raster voxelization (T 5.1.2): projects the triangle along its dominant axis (T eq. 10-13), one pixel per voxel column.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "voxel_triangle.glsl"
layout(triangles) in;
layout(triangle_strip, max_vertices = 3) out;
layout(push_constant, scalar) uniform Push { VoxelizePush push; };
layout(location = 0) flat in uint triangleOfVertex[];
layout(location = 0) flat out uvec2 triangleAxis;
layout(location = 1) flat out vec3 plane;   // depth = plane.z + plane.xy . (pixel - corner)
layout(location = 2) flat out vec2 corner;

void main() {
  uint triangle = triangleOfVertex[0];
  VoxelTriangle t = loadTriangle(push.scene, push.grid, triangle);
  if (degenerate(t)) return;
  uint d = t.axis;
  uint u = (d + 1u) % 3u;
  uint w = (d + 2u) % 3u;
  uvec3 dims = push.grid.at[0].dims;
  float scale = 2.0 / float(max(dims.x, max(dims.y, dims.z)));
  for (int i = 0; i < 3; ++i) {
    triangleAxis = uvec2(triangle, d);
    plane = vec3(-t.normal[u] / t.normal[d], -t.normal[w] / t.normal[d], t.v[0][d]);
    corner = vec2(t.v[0][u], t.v[0][w]);
    // The viewport's y points up: negated here, so that the pixel's row is the voxel's.
    gl_Position = vec4(t.v[i][u] * scale - 1.0, 1.0 - t.v[i][w] * scale, 0.0, 1.0);
    EmitVertex();
  }
  EndPrimitive();
}
