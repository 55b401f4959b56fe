// Colour maps of scalar views, and the display's transfer function: pictures and their legends use the same.
#ifndef IRAD_SHARED_COLOR_MAP_H
#define IRAD_SHARED_COLOR_MAP_H
#include "shared/enumeration.h"
IRAD_BEGIN

// clang-format off
#define IRAD_COLOR_MAPS(X, E) \
  X(E, violetYellow, "violet-yellow", COLOR_MAP_VIOLET_YELLOW, 0) \
  X(E, heat,         "heat",          COLOR_MAP_HEAT,          1) \
  X(E, grey,         "grey",          COLOR_MAP_GREY,          2)
IRAD_SHARED_ENUM(ColorMap, IRAD_COLOR_MAPS)
// clang-format on
/// The map of signed views, after those that can be chosen.
#define IRAD_COLOR_MAP_COUNT(E, id, text, constant, number) +1u
IRAD_CONST IRAD_AS(ColorMap) COLOR_MAP_BLUE_RED = IRAD_AS(ColorMap)(IRAD_COLOR_MAPS(IRAD_COLOR_MAP_COUNT, ColorMap));
#undef IRAD_COLOR_MAP_COUNT

/// IEC 61966-2-1.
IRAD_FN float encodeSrgb(float c) {
  c = clamp(c, 0.0f, 1.0f);
  return c > 0.0031308f ? 1.055f * pow(c, 1.0f / 2.4f) - 0.055f : 12.92f * c;
}
IRAD_FN vec3 encodeSrgb(vec3 c) { return vec3(encodeSrgb(c.x), encodeSrgb(c.y), encodeSrgb(c.z)); }

/// OKLab (Ottosson 2020) in polar form to linear sRGB, clamped to the gamut. `hue` in radians.
IRAD_FN vec3 fromOklch(float lightness, float chroma, float hue) {
  float a = chroma * cos(hue);
  float b = chroma * sin(hue);
  float l = lightness + 0.3963377774f * a + 0.2158037573f * b;
  float m = lightness - 0.1055613458f * a - 0.0638541728f * b;
  float s = lightness - 0.0894841775f * a - 1.2914855480f * b;
  vec3 lms = vec3(l * l * l, m * m * m, s * s * s);
  return clamp(vec3(4.0767416621f * lms.x - 3.3077115913f * lms.y + 0.2309699292f * lms.z,
                    -1.2684380046f * lms.x + 2.6097574011f * lms.y - 0.3413193965f * lms.z,
                    -0.0041960863f * lms.x - 0.7034186147f * lms.y + 1.7076147010f * lms.z),
               0.0f, 1.0f);
}

/// Colour of t in 0..1, linear sRGB. Lightness rises evenly in OKLab, so that equal steps look equal and grey prints keep
/// their order; that of the diverging map falls evenly to both sides of t = 1/2.
IRAD_FN vec3 colorMap(IRAD_AS(ColorMap) map, float t) {
  t = clamp(t, 0.0f, 1.0f);
  float arch = sin(IRAD_PI * t);
  if (map == COLOR_MAP_GREY) return fromOklch(0.15f + 0.80f * t, 0.0f, 0.0f);
  if (map == COLOR_MAP_HEAT) return fromOklch(0.15f + 0.80f * t, 0.05f + 0.13f * arch, 0.35f + 1.55f * t);
  if (map == COLOR_MAP_BLUE_RED) {
    float side = abs(2.0f * t - 1.0f);
    return fromOklch(0.95f - 0.50f * side, 0.17f * side, t < 0.5f ? 4.55f : 0.48f);
  }
  return fromOklch(0.25f + 0.68f * t, (0.11f + 0.06f * t) * (1.0f - 0.25f * arch), 5.25f - 3.40f * t);
}

/// Where in the map a value lies: 0..1 from `low` to `high`, either may be the larger; the middle where both are the same.
IRAD_FN float colorMapPosition(float value, float low, float high) {
  return low == high ? 0.5f : clamp((value - low) / (high - low), 0.0f, 1.0f);
}

IRAD_END
#endif
