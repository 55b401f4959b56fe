// The sky's radiance along a direction.
#ifndef IRAD_SKY_GLSL
#define IRAD_SKY_GLSL
#include "shared/sky.h"

vec3 skyRadiance(SkyPicture sky, vec3 direction) {
  SkyTaps taps = skyTaps(direction, sky.size, sky.turn);
  vec3 sum = vec3(0.0);
  for (int i = 0; i < 4; ++i) sum += taps.weight[i] * sky.texels.at[taps.texel[i]];
  return sum * sky.scale;
}

#endif
