// "RE Shadow" by kernels: a layer of the flat maps from raster/shadow.comp's words.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "shared/raster.h"

layout(local_size_x = 16, local_size_y = 16) in;
layout(push_constant, scalar) uniform PushBlock { StoreShadowPush push; };
layout(set = 0, binding = 0, r32f) uniform writeonly image2DArray shadowFlat;

void main() {
  ivec2 size = imageSize(shadowFlat).xy;
  ivec2 texel = ivec2(gl_GlobalInvocationID.xy);
  if (any(greaterThanEqual(texel, size))) return;
  imageStore(shadowFlat, ivec3(texel, push.layer), vec4(uintBitsToFloat(push.words.at[texel.y * size.x + texel.x])));
}
