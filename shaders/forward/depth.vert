// Depth only: shadow maps (RE Shadow) and the depth prepass (RE Depth). An indexed draw: a vertex is projected once for
// the triangles around it.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "forward/project.glsl"
#include "shared/passes.h"

layout(push_constant, scalar) uniform PushBlock {
  DepthPush push;
};

void main() {
  GpuScene scene = push.scene.at[0];
  vec3 position = scene.positions.at[gl_VertexIndex];
  precise vec4 clip = project(push.projection.at[0].matrix, position);
  gl_Position = clip;
}
