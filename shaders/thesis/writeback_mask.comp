#version 460
#extension GL_GOOGLE_include_directive : require
#include "thesis/writeback_mask.glsl"

layout(local_size_x = 8, local_size_y = 8) in;

void main() {
  GpuCamera camera = push.camera.at[0];
  if (all(lessThan(gl_GlobalInvocationID.xy, camera.size))) writeBack(camera, ivec2(gl_GlobalInvocationID.xy));
}
