// The reference picture beside the one that was drawn: as high as the view and in its middle, where it belongs if it
// was made with the same camera. Bilinear where the sizes differ.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "shared/constants.h"
#include "shared/debug_views.h"
#include "shared/emitters.h"
#include "shared/view.h"

layout(local_size_x = 8, local_size_y = 8) in;
layout(constant_id = CONSTANT_VIEW) const uint VIEW = 0u;
layout(set = 0, binding = 0) uniform sampler2D referencePicture;
layout(set = 0, binding = 1, rgba32f) uniform image2D linearTarget;
layout(push_constant, scalar) uniform PushBlock { ReferencePush push; };

void main() {
  uvec2 pixel = gl_GlobalInvocationID.xy;
  if (any(greaterThanEqual(pixel, push.size))) return;
  float scale = float(push.referenceSize.y) / float(push.size.y);
  vec2 at = (vec2(pixel) + 0.5 - 0.5 * vec2(push.size)) * scale + 0.5 * vec2(push.referenceSize);
  vec4 shown = vec4(0.0);
  if (all(greaterThanEqual(at, vec2(0.0))) && all(lessThan(at, vec2(push.referenceSize)))) {
    vec3 reference = push.size == push.referenceSize ? texelFetch(referencePicture, ivec2(pixel), 0).rgb
                                                     : textureLod(referencePicture, at / vec2(push.referenceSize), 0.0).rgb;
    shown = vec4(reference, 1.0);
    if (VIEW == VIEW_ERROR) {
      float r = luminance(reference);
      float error = (luminance(imageLoad(linearTarget, ivec2(pixel)).rgb) - r) / sqrt(r * r + VIEW_ERROR_EPSILON);
      shown = vec4(vec3(error), 1.0);
    }
  }
  imageStore(linearTarget, ivec2(pixel), shown);
}
