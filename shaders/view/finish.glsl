// From a view's linear result to the picture that is shown: exposure, tone curve, colour map, sRGB; NaN red, infinite
// green, negative blue.
#ifndef IRAD_VIEW_FINISH_GLSL
#define IRAD_VIEW_FINISH_GLSL
#include "shared/debug_views.h"
#include "shared/gi_params.h"

/// IEC 61966-2-1.
vec3 encodeSrgb(vec3 c) {
  c = clamp(c, 0.0, 1.0);
  return mix(12.92 * c, 1.055 * pow(c, vec3(1.0 / 2.4)) - 0.055, greaterThan(c, vec3(0.0031308)));
}

/// Khronos PBR Neutral tone mapper (Khronos Group, 2024): keeps base colours below 0.8, desaturates what is above.
vec3 toneNeutral(vec3 c) {
  const float start = 0.8 - 0.04;
  const float desaturation = 0.15;
  float x = min(c.r, min(c.g, c.b));
  c -= x < 0.08 ? x - 6.25 * x * x : 0.04;
  float peak = max(c.r, max(c.g, c.b));
  if (peak < start) return c;
  float d = 1.0 - start;
  float newPeak = 1.0 - d * d / (peak + d - start);
  c *= newPeak / peak;
  float g = 1.0 - 1.0 / (desaturation * (peak - newPeak) + 1.0);
  return mix(c, vec3(newPeak), g);
}

/// Colour map, t in 0..1 to linear sRGB: lightness rises evenly in OKLab (Ottosson 2020) while the hue turns from violet
/// over blue and green to yellow, so that equal steps look equal and grey prints keep their order.
vec3 colorMap(float t) {
  float lightness = mix(0.25, 0.93, t);
  float hue = mix(5.25, 1.85, t);
  float chroma = mix(0.11, 0.17, t) * (1.0 - 0.25 * sin(IRAD_PI * t));
  vec2 ab = chroma * vec2(cos(hue), sin(hue));
  vec3 lms = vec3(lightness + 0.3963377774 * ab.x + 0.2158037573 * ab.y,
                  lightness - 0.1055613458 * ab.x - 0.0638541728 * ab.y,
                  lightness - 0.0894841775 * ab.x - 1.2914855480 * ab.y);
  lms = lms * lms * lms;
  return clamp(vec3(dot(lms, vec3(4.0767416621, -3.3077115913, 0.2309699292)),
                    dot(lms, vec3(-1.2684380046, 2.6097574011, -0.3413193965)),
                    dot(lms, vec3(-0.0041960863, -0.7034186147, 1.7076147010))),
               0.0, 1.0);
}

/// The display colour of `value`; `drawn` is false where the view has nothing (background). `ink` (0..1) darkens lines
/// drawn over the picture.
vec3 displayColor(vec3 value, bool drawn, float ink, uint kind, float low, float high, float exposure, uint toneCurve) {
  if (any(isnan(value))) return vec3(1.0, 0.0, 0.0);
  if (any(isinf(value))) return vec3(0.0, 1.0, 0.0);
  if (kind != VIEW_KIND_NORMAL && any(lessThan(value, vec3(0.0)))) return vec3(0.0, 0.0, 1.0);
  if (!drawn) return vec3(0.0);
  if (kind == VIEW_KIND_NORMAL) return (value * 0.5 + 0.5) * ink;
  vec3 c = value;
  if (kind == VIEW_KIND_SCALAR) c = colorMap(clamp((value.x - low) / (high - low), 0.0, 1.0));
  if (kind == VIEW_KIND_IRRADIANCE) c *= 1.0 / IRAD_PI;
  if (kind == VIEW_KIND_LIGHT || kind == VIEW_KIND_IRRADIANCE) {
    c *= exposure;
    if (toneCurve == TONE_NEUTRAL) c = toneNeutral(min(c, vec3(1e6)));
  }
  return encodeSrgb(c) * ink;
}

#endif
