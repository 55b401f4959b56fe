// Depth only, for alpha-masked materials: texture coordinates and the vertex's alpha as well.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "forward/project.glsl"
#include "shared/passes.h"

layout(push_constant, scalar) uniform PushBlock {
  DepthPush push;
};

layout(location = 0) out vec4 uv;
layout(location = 1) out vec4 tint;
layout(location = 2) flat out uint corner;  ///< the triangle's first vertex

void main() {
  GpuScene scene = push.scene.at[0];
  uint vertex = gl_VertexIndex;
  uv = vec4(scene.uv0.at[vertex], scene.uv1.at[vertex]);
  tint = scene.colors.at[vertex];
  corner = vertex;
  precise vec4 clip = project(push.projection.at[0].matrix, scene.positions.at[vertex]);
  gl_Position = clip;
}
