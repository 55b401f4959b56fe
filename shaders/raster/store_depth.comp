// "RE Depth" by kernels: the depth target from raster/visible.comp's words; where nothing is seen those are ~0.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "shared/raster.h"

layout(local_size_x = 16, local_size_y = 16) in;
layout(push_constant, scalar) uniform PushBlock {
  VisibleArray visible;
};
layout(set = 0, binding = 0, r32f) uniform writeonly image2D depthTarget;

void main() {
  ivec2 size = imageSize(depthTarget);
  ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
  if (any(greaterThanEqual(pixel, size))) return;
  uvec2 seen = unpack32(visible.at[pixel.y * size.x + pixel.x]);
  imageStore(depthTarget, pixel, vec4(uintBitsToFloat(~seen.y)));
}
