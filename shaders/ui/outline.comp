// The outline of an object: the pixels around those that it covers, and a darker rim around these, for any ground.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "shared/ui.h"

layout(local_size_x = 8, local_size_y = 8) in;
layout(set = 0, binding = 0) uniform sampler2D depth;
layout(set = 0, binding = 1) uniform sampler2D picture;  // the depth of all surfaces, or of the object again
layout(set = 0, binding = 2, rgba8) uniform writeonly image2D outline;
layout(push_constant, scalar) uniform PushBlock { OutlinePush push; };

const float RIM = 0.6;     // opacity
const float BEHIND = 0.3;  // of all of it, where something is before the object

bool covered(ivec2 pixel) {
  ivec2 last = ivec2(push.size) - 1;
  return texelFetch(depth, clamp(pixel, ivec2(0), last), 0).x > 0.0;
}

/// Depth is reversed, near / z: the two are drawn of the same triangles, and so alike but for rounding.
bool behind(ivec2 pixel) {
  return texelFetch(picture, pixel, 0).x > 1.0005 * texelFetch(depth, pixel, 0).x;
}

void main() {
  if (any(greaterThanEqual(gl_GlobalInvocationID.xy, push.size))) return;
  ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
  vec4 color = vec4(0.0);
  if (!covered(pixel)) {
    // To the nearest pixel that is covered, up to the rim's outer edge.
    int reach = push.reach + 1;
    int nearest = (reach + 1) * (reach + 1);
    ivec2 at = pixel;
    for (int y = -reach; y <= reach; ++y)
      for (int x = -reach; x <= reach; ++x)
        if (x * x + y * y < nearest && covered(pixel + ivec2(x, y))) {
          nearest = x * x + y * y;
          at = clamp(pixel + ivec2(x, y), ivec2(0), ivec2(push.size) - 1);
        }
    if (nearest <= push.reach * push.reach) color = vec4(push.color_, push.blue, 1.0);
    else if (nearest <= reach * reach) color = vec4(0.0, 0.0, 0.0, RIM);
    if (color.a > 0.0 && behind(at)) color.a *= BEHIND;
  }
  imageStore(outline, pixel, color);
}
