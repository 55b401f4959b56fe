// The sky's radiance along a direction.
#ifndef IRAD_SKY_GLSL
#define IRAD_SKY_GLSL
#include "shared/sky.h"

vec3 skyTexel(SkyPicture sky, Vec3Array texels, vec3 direction) {
  SkyTaps taps = skyTaps(direction, sky.size, sky.turn);
  vec3 sum = vec3(0.0);
  for (int i = 0; i < 4; ++i) sum += taps.weight[i] * texels.at[taps.texel[i]];
  return sum * sky.scale;
}

/// Without its sun, which is one of the lights.
vec3 skyRadiance(SkyPicture sky, vec3 direction) { return skyTexel(sky, sky.texels, direction); }
/// With it.
vec3 skySeen(SkyPicture sky, vec3 direction) { return skyTexel(sky, sky.whole, direction); }

#endif
