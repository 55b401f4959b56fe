// The thesis's octahedral normals, for GLSL and C++ like shared/normals.h.
#ifndef IRAD_THESIS_OCT8_LITERAL_H
#define IRAD_THESIS_OCT8_LITERAL_H
#include "shared/types.h"
IRAD_BEGIN

/// T eq. 16-19 to the letter (thesis.literal): sign(0) = 0 puts -Z into the middle of the square, where +Z is; code 0
/// becomes 1.
IRAD_FN uint encodeOct8Literal(vec3 n) {
  vec2 p = vec2(n.x, n.y) * (1.0f / (abs(n.x) + abs(n.y) + abs(n.z)));
  if (n.z < 0.0f) p = vec2((1.0f - abs(p.y)) * sign(p.x), (1.0f - abs(p.x)) * sign(p.y));
  uint code = (uint(floor((p.x + 1.0f) * 0.5f * 15.0f + 0.5f)) << 4) | uint(floor((p.y + 1.0f) * 0.5f * 15.0f + 0.5f));
  return code == 0u ? 1u : code;
}

IRAD_END
#endif
