// "RE Forward": the same positions as the depth prepass, bit for bit, and everything that shading reads.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "forward/project.glsl"
#include "shared/passes.h"

layout(push_constant, scalar) uniform PushBlock {
  ForwardPush push;
};
layout(location = 0) out vec3 local;
layout(location = 1) out vec3 normal;
layout(location = 2) out vec4 tangent;
layout(location = 3) out vec4 uv;
layout(location = 4) out vec4 tint;
layout(location = 5) flat out vec3 faceNormal;  ///< of the triangle, not unit; set by its first vertex
layout(location = 6) out vec3 towardsEye;       ///< not unit; affine in the position
layout(location = 7) flat out uint triangle;

void main() {
  GpuScene scene = push.scene.at[0];
  uint vertex = scene.indices.at[gl_VertexIndex];
  local = scene.positions.at[vertex];
  normal = scene.normals.at[vertex];
  tangent = scene.tangents.at[vertex];
  uv = vec4(scene.uv0.at[vertex], scene.uv1.at[vertex]);
  tint = scene.colors.at[vertex];
  triangle = uint(gl_VertexIndex) / 3u;
  faceNormal = vec3(0.0);
  if (gl_VertexIndex % 3 == 0) {
    vec3 b = scene.positions.at[scene.indices.at[gl_VertexIndex + 1]];
    vec3 c = scene.positions.at[scene.indices.at[gl_VertexIndex + 2]];
    faceNormal = cross(b - local, c - local);
  }
  GpuCamera camera = push.camera.at[0];
  mat4 m = camera.viewProjection;
  towardsEye = camera.orthographic != 0u ? vec3(m[0][2], m[1][2], m[2][2]) : camera.position - local;
  precise vec4 clip = project(m, local);
  gl_Position = clip;
}
