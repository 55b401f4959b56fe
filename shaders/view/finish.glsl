// From a view's linear result to the picture that is shown: exposure, tone curve, sRGB; NaN red, infinite green,
// negative blue.
#ifndef IRAD_VIEW_FINISH_GLSL
#define IRAD_VIEW_FINISH_GLSL
#include "shared/color_map.h"
#include "shared/debug_views.h"
#include "shared/gi_params.h"

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

/// Radiance as a picture shows it.
vec3 displayLight(vec3 radiance, float exposure, uint toneCurve) {
  vec3 c = radiance * exposure;
  if (toneCurve == TONE_NEUTRAL) c = toneNeutral(min(c, vec3(1e6)));
  return encodeSrgb(c);
}

/// Whether a value is marked instead of shown, and the mark's colour.
bool isMarked(vec3 value, uint kind, out vec3 mark) {
  mark = vec3(1.0, 0.0, 0.0);
  if (any(isnan(value))) return true;
  mark = vec3(0.0, 1.0, 0.0);
  if (any(isinf(value))) return true;
  mark = vec3(0.0, 0.0, 1.0);
  return !viewHasSign(kind) && any(lessThan(value, vec3(0.0)));
}

/// The display colour of a value of a kind without range; `drawn` is false where the view has nothing (background).
vec3 displayColor(vec3 value, bool drawn, uint kind, float exposure, uint toneCurve) {
  vec3 mark;
  if (isMarked(value, kind, mark)) return mark;
  if (!drawn) return vec3(0.0);
  if (kind == VIEW_KIND_NORMAL) return value * 0.5 + 0.5;
  if (kind == VIEW_KIND_LIGHT) return displayLight(value, exposure, toneCurve);
  if (kind == VIEW_KIND_IRRADIANCE) return displayLight(value * (1.0 / IRAD_PI), exposure, toneCurve);
  return encodeSrgb(value);
}

#endif
