// Points of the part of a triangle in a voxel, uniform over its area.
#ifndef IRAD_PIECE_PLACE_H
#define IRAD_PIECE_PLACE_H
#include "gi/triangle_hit.h"
#include "gi/voxel_clip.h"
#include "shared/sampling.h"
IRAD_BEGIN

/// A point of the clipped polygon, uniform over its area for u uniform over the square.
IRAD_FN vec3 polygonPoint(uint from, uint n, float area, vec2 u) {
  vec3 first = clipCorner(from, 0u);
  float left = u.x * area;
  vec3 d = vec3(0.0f), e = vec3(0.0f);
  IRAD_DONT_UNROLL for (uint i = 2u; i < n; ++i) {
    d = clipCorner(from, i - 1u) - first;
    e = clipCorner(from, i) - first;
    float fan = 0.5f * length(cross(d, e));
    if (left < fan || i + 1u == n) {
      float x = fan > 0.0f ? clamp(left / fan, 0.0f, 1.0f) : 0.5f;
      // Along the fan by x, from its tip by the root of u.y: uniform.
      float r = sqrt(u.y);
      return first + r * mix(d, e, x);
    }
    left -= fan;
  }
  return first;
}

/// Where point k of a cut piece is; `again` moves it.
IRAD_FN vec2 cutPlace(uint piece, uint k, uint again) {
  return vec2((float(k) + unitFloat(hashUint(piece + 0x9E3779B9u * again))) / float(CUT_POINTS),
              unitFloat(reverseBits(k) + hashUint(piece ^ (again << 28))));
}

#ifndef __cplusplus
/// Points 0 to CUT_POINTS - 1 of cutPlace(piece, ., 0) at once, each as polygonPoint() has it, in the place of the polygons'
/// corners, which are lost: cutPoint(k).
void putCutPoints(uint piece, uint from, uint n, float area) {
  float left[CUT_POINTS], root[CUT_POINTS];
  vec3 first = clipCorner(from, 0u), points[CUT_POINTS];
  IRAD_UNROLL for (uint k = 0u; k < CUT_POINTS; ++k) {
    vec2 u = cutPlace(piece, k, 0u);
    left[k] = u.x * area;
    root[k] = sqrt(u.y);
    points[k] = first;
  }
  uint open = (1u << CUT_POINTS) - 1u;
  vec3 e = clipCorner(from, 1u) - first;
  IRAD_DONT_UNROLL for (uint i = 2u; i < n; ++i) {
    vec3 d = e;
    e = clipCorner(from, i) - first;
    float fan = 0.5f * length(cross(d, e));
    IRAD_UNROLL for (uint k = 0u; k < CUT_POINTS; ++k) {
      if ((open & (1u << k)) != 0u && (left[k] < fan || i + 1u == n)) {
        float x = fan > 0.0f ? clamp(left[k] / fan, 0.0f, 1.0f) : 0.5f;
        points[k] = first + root[k] * mix(d, e, x);
        open &= ~(1u << k);
      }
      left[k] -= fan;
    }
  }
  IRAD_UNROLL for (uint k = 0u; k < CUT_POINTS; ++k) setClipCorner(0u, k, points[k]);  // CUT_POINTS < CLIP_CORNERS
}
vec3 cutPoint(uint k) { return clipCorner(0u, k); }
#endif

IRAD_END
#endif
