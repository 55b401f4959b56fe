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

IRAD_END
#endif
