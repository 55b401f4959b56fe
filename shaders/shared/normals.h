// Normal encodings (docs/method.md 2, T 5.1.3): axis6, axis26, oct8 (T eq. 16-21), oct16. Code 0 is never used, so that
// 0 can mean "empty" in the thesis's alpha channel. `nonNegative ? 1 : -1` everywhere: GLSL's sign(0) is 0 and would
// decode -Z 174 degrees wrong.
#ifndef IRAD_SHARED_NORMALS_H
#define IRAD_SHARED_NORMALS_H
#include "shared/enumeration.h"
IRAD_BEGIN

// clang-format off
#define IRAD_NORMAL_ENCODINGS(X, E) \
  X(E, axis6,  "axis6",  NORMALS_AXIS6,  0) \
  X(E, axis26, "axis26", NORMALS_AXIS26, 1) \
  X(E, oct8,   "oct8",   NORMALS_OCT8,   2) \
  X(E, oct16,  "oct16",  NORMALS_OCT16,  3)
IRAD_SHARED_ENUM(NormalEncoding, IRAD_NORMAL_ENCODINGS)
// clang-format on

IRAD_FN float signNotZero(float x) {
  return x >= 0.0f ? 1.0f : -1.0f;
}

/// Octahedral map of a unit vector to [-1, 1]^2 (T eq. 16-17) and back (T eq. 20-21), there from a square of half edge
/// `extent`: whole numbers stay exact in it, and axes and zeros with them, also where a GPU fuses products into sums.
IRAD_FN vec2 octWrap(vec3 n) {
  float l1 = abs(n.x) + abs(n.y) + abs(n.z);
  vec2 p = vec2(n.x / l1, n.y / l1);
  if (n.z < 0.0f) p = vec2((1.0f - abs(p.y)) * signNotZero(p.x), (1.0f - abs(p.x)) * signNotZero(p.y));
  return p;
}
IRAD_FN vec3 octUnwrap(vec2 p, float extent) {
  float z = extent - abs(p.x) - abs(p.y);
  if (z < 0.0f) p = vec2((extent - abs(p.y)) * signNotZero(p.x), (extent - abs(p.x)) * signNotZero(p.y));
  return normalize(vec3(p.x, p.y, z) * (1.0f / extent));
}

/// Unit vector -> code in [1, 65535] (axis6: 1..6, axis26: 1..26, oct8: 1..255).
IRAD_FN uint encodeNormal(vec3 n, IRAD_AS(NormalEncoding) encoding) {
  if (encoding == NORMALS_AXIS6) {
    vec3 a = abs(n);
    if (a.x >= a.y && a.x >= a.z) return n.x >= 0.0f ? 1u : 2u;
    if (a.y >= a.z) return n.y >= 0.0f ? 3u : 4u;
    return n.z >= 0.0f ? 5u : 6u;
  }
  if (encoding == NORMALS_AXIS26) {
    // Nearest of the 26 lattice directions: keep the k largest components, k maximizing sum / sqrt(k).
    vec3 a = abs(n);
    float hi = max(a.x, max(a.y, a.z));
    float lo = min(a.x, min(a.y, a.z));
    float mid = max(min(a.x, a.y), min(max(a.x, a.y), a.z));
    float d1 = hi;
    float d2 = (hi + mid) * 0.70710678f;
    float d3 = (hi + mid + lo) * 0.57735027f;
    float keep = d1 >= d2 && d1 >= d3 ? hi : (d2 >= d3 ? mid : lo);
    uint kept = d1 >= d2 && d1 >= d3 ? 1u : (d2 >= d3 ? 2u : 3u);
    uint code = 0u;
    uint taken = 0u;
    uint digit[3];
    for (int i = 0; i < 3; ++i) {
      bool in_ = a[i] >= keep && taken < kept;
      if (in_) ++taken;
      digit[i] = in_ ? (n[i] >= 0.0f ? 2u : 0u) : 1u;
    }
    code = digit[0] + 3u * digit[1] + 9u * digit[2];  // 0..26, 13 is the origin
    return code < 13u ? code + 1u : code;             // 1..26
  }
  vec2 p = octWrap(n);
  if (encoding == NORMALS_OCT8) {
    uint qx = uint(floor((p.x + 1.0f) * 0.5f * 15.0f + 0.5f));
    uint qy = uint(floor((p.y + 1.0f) * 0.5f * 15.0f + 0.5f));
    uint code = (qx << 4) | qy;
    return code == 0u ? 15u : code;  // corners are all -Z: costs 0 degrees (docs/method.md 2)
  }
  // oct16: odd grid 0..254 per axis, so that 127 is exactly 0 and the axes are exact; +1 keeps 0 free.
  uint x = uint(floor((p.x + 1.0f) * 127.0f + 0.5f));
  uint y = uint(floor((p.y + 1.0f) * 127.0f + 0.5f));
  return ((x << 8) | y) + 1u;
}

IRAD_FN vec3 decodeNormal(uint code, IRAD_AS(NormalEncoding) encoding) {
  if (encoding == NORMALS_AXIS6) {
    uint axis = (code - 1u) >> 1;
    float s = ((code - 1u) & 1u) == 0u ? 1.0f : -1.0f;
    return vec3(axis == 0u ? s : 0.0f, axis == 1u ? s : 0.0f, axis == 2u ? s : 0.0f);
  }
  if (encoding == NORMALS_AXIS26) {
    uint c = code <= 13u ? code - 1u : code;
    return normalize(vec3(float(c % 3u) - 1.0f, float((c / 3u) % 3u) - 1.0f, float(c / 9u) - 1.0f));
  }
  if (encoding == NORMALS_OCT8) return octUnwrap(2.0f * vec2(float(code >> 4), float(code & 15u)) - vec2(15.0f), 15.0f);
  uint c = code - 1u;
  return octUnwrap(vec2(float(c >> 8), float(c & 255u)) - vec2(127.0f), 127.0f);
}

IRAD_END
#endif
