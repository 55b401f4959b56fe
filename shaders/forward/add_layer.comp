// "RE Glass": the picture of one layer of surfaces, the nearest first, into the sum of what reaches the eye. What it covers
// of what is behind it goes by its alpha; where nothing is drawn, or no glass, the picture is whole. IRAD_TINTED: panes tint
// what is behind them.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "shared/glass.h"
#include "shared/passes.h"

layout(local_size_x = 8, local_size_y = 8) in;
layout(set = 0, binding = 0) uniform sampler2D depthTarget;
layout(set = 0, binding = 1, rgba16f) uniform readonly image2D geometricTarget;
layout(set = 0, binding = 2, rgba32f) uniform image2D linearTarget;
layout(set = 0, binding = 3, rgba32f) uniform image2D layersTarget;
layout(set = 0, binding = 4, r32f) uniform writeonly image2D peeledTarget;
#ifdef IRAD_TINTED
layout(set = 0, binding = 5, rgba32f) uniform readonly image2D directTarget;
layout(set = 0, binding = 6, rgba32f) uniform image2D showsTarget;
#endif
layout(push_constant, scalar) uniform PushBlock { LayerPush push; };

void main() {
  ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
  if (any(greaterThanEqual(pixel, imageSize(linearTarget)))) return;
  vec4 layer = imageLoad(linearTarget, pixel);
  float depth = texelFetch(depthTarget, pixel, 0).x;
  float cover = depth > 0.0 ? coverOf(imageLoad(geometricTarget, pixel).w) : 1.0;
  vec4 sum = push.first != 0u ? vec4(0.0, 0.0, 0.0, 1.0) : imageLoad(layersTarget, pixel);
#ifdef IRAD_TINTED
  vec3 shows = push.first != 0u ? vec3(1.0) : imageLoad(showsTarget, pixel).rgb;
  sum.rgb += shows * (cover * layer.rgb);
  if (depth > 0.0) shows *= unpackPasses(floatBitsToUint(imageLoad(directTarget, pixel).w) - 0x3F800000u);
  else shows = vec3(0.0);
  imageStore(showsTarget, pixel, vec4(shows, 1.0));
#else
  if (sum.w > 0.0) {
    sum.rgb += sum.w * cover * layer.rgb;
    sum.w *= 1.0 - cover;
  }
#endif
  // Where the nearest surface is none nothing is drawn: -1 says so to the end.
  if (push.first != 0u && layer.w == 0.0) sum.w = -1.0;
  imageStore(layersTarget, pixel, sum);
  imageStore(peeledTarget, pixel, vec4(depth));
  if (push.last != 0u) imageStore(linearTarget, pixel, vec4(sum.rgb, sum.w < 0.0 ? 0.0 : 1.0));
}
