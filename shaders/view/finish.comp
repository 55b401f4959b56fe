// Views whose display picture needs the whole linear one first (a range), or the scene around (a slice), or that dim what
// they drew: the alpha of `linear` is 0 where nothing is drawn, else the share of the display colour that remains.
#version 460
#extension GL_GOOGLE_include_directive : require
#include "shared/constants.h"
#include "shared/sampling.h"
#include "shared/view.h"
#include "view/finish.glsl"

layout(local_size_x = 8, local_size_y = 8) in;
layout(constant_id = CONSTANT_HAS_INDIRECT) const bool INDIRECT = true;  ///< there is such a target
layout(set = 0, binding = 0, rgba32f) uniform readonly image2D linearTarget;
layout(set = 0, binding = 1, rgba16f) uniform readonly image2D albedoTarget;
layout(set = 0, binding = 2, rgba32f) uniform readonly image2D directTarget;
layout(set = 0, binding = 3, rgba32f) uniform readonly image2D indirectTarget;
layout(set = 0, binding = 4, rgba8) uniform writeonly image2D displayTarget;
layout(push_constant, scalar) uniform PushBlock { FinishPush push; };

float exposure() {
  if (push.automatic == 0u) return push.exposure;
  float factor = autoExposure(push.range.at[0]);
  return push.exposure * (push.kind == VIEW_KIND_IRRADIANCE ? factor * IRAD_PI : factor);  // which is shown divided by it
}

/// The lit scene in dim grey.
vec3 surroundings(ivec2 pixel) {
  vec4 albedo = imageLoad(albedoTarget, pixel);
  vec3 indirect = INDIRECT ? imageLoad(indirectTarget, pixel).rgb : vec3(0.0);
  vec3 light = imageLoad(directTarget, pixel).rgb + albedo.a * indirect;
  vec3 shown = displayLight(albedo.rgb * light * (1.0 / IRAD_PI), exposure(), push.toneCurve);
  return vec3(0.35 * dot(shown, vec3(0.2126, 0.7152, 0.0722)));
}

/// Where in the grid a voxel lies, as colour; a brightness of its own tells it from its neighbours.
vec3 siteColor(uvec3 voxel) {
  uint h = hashUint(voxel.x + 1024u * (voxel.y + 1024u * voxel.z));
  return (0.15 + 0.85 * (vec3(voxel) + 0.5) / vec3(push.dims)) * (0.65 + 0.35 * float(h & 255u) / 255.0);
}

vec3 shownColor(vec3 value) {
  if (push.kind == VIEW_KIND_SITE) return siteColor(uvec3(value));
  if (!viewHasRange(push.kind)) return displayColor(value, true, push.kind, exposure(), push.toneCurve);
  ViewRange range = push.range.at[0];
  return encodeSrgb(colorMap(push.colorMap, colorMapPosition(value.x, range.low, range.high)));
}

void main() {
  if (any(greaterThanEqual(gl_GlobalInvocationID.xy, push.size))) return;
  ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
  vec4 drawn = imageLoad(linearTarget, pixel);
  vec3 shown;
  if (!isMarked(drawn.rgb, push.kind, shown)) {
    if (drawn.a > 0.0)
      shown = shownColor(drawn.rgb) * drawn.a;
    else
      shown = push.surroundings != 0u ? surroundings(pixel) : vec3(0.0);
  }
  imageStore(displayTarget, pixel, vec4(shown, 1.0));
}
