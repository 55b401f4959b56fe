// Raster voxelization (T 5.1.2): the geometry stage fetches its whole triangle by number.
#version 460
layout(location = 0) flat out uint triangleOfVertex;

void main() {
  triangleOfVertex = uint(gl_VertexIndex) / 3u;
  gl_Position = vec4(0.0, 0.0, 0.0, 1.0);
}
