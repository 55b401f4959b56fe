// Depth only: shadow maps (RE Shadow) and the depth prepass (RE Depth). Vertices are pulled by index.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "shared/passes.h"

layout(push_constant, scalar) uniform PushBlock { DepthPush push; };

invariant gl_Position;

void main() {
  GpuScene scene = push.scene.at[0];
  vec3 position = scene.positions.at[scene.indices.at[gl_VertexIndex]];
  gl_Position = push.projection.at[0].matrix * vec4(position, 1.0);
}
