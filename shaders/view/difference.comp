// The values of one picture of a view less those of another: of light and colours the luminance, between normals the
// angle in degrees, 1 where voxels are not the same.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "shared/debug_views.h"
#include "shared/emitters.h"
#include "shared/view.h"

layout(local_size_x = 8, local_size_y = 8) in;
layout(set = 0, binding = 0, rgba32f) uniform readonly image2D values;
layout(set = 0, binding = 1, rgba32f) uniform readonly image2D referenceValues;
layout(set = 0, binding = 2, rgba32f) uniform writeonly image2D difference;
layout(push_constant, scalar) uniform PushBlock { DifferencePush push; };

void main() {
  if (any(greaterThanEqual(gl_GlobalInvocationID.xy, push.size))) return;
  ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
  vec4 v = imageLoad(values, pixel);
  vec4 r = imageLoad(referenceValues, pixel);
  float shown = luminance(v.rgb - r.rgb);
  if (viewHasRange(push.kind)) shown = v.x - r.x;
  if (push.kind == VIEW_KIND_NORMAL) shown = degrees(2.0 * asin(clamp(0.5 * length(v.xyz - r.xyz), 0.0, 1.0)));
  if (push.kind == VIEW_KIND_SITE) shown = v.xyz == r.xyz ? 0.0 : 1.0;
  imageStore(difference, pixel, vec4(vec3(shown), max(v.a, r.a) > 0.0 ? 1.0 : 0.0));
}
