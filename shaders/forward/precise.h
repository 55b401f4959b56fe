// Products whose order and rounding are as written in every variant of a shader. A driver may fuse the built-in ones,
// and may decide otherwise once a branch beside them is specialized away; but leaving out an effect that a scene does
// not have must not change a bit of the others. Their arguments have to be `precise` where they are computed: the
// qualifier does not pass through a call.
#ifndef IRAD_FORWARD_PRECISE_H
#define IRAD_FORWARD_PRECISE_H
#include "shared/types.h"
IRAD_BEGIN
#ifdef __cplusplus
using glm::inversesqrt;
#endif

IRAD_FN float preciseDot(vec3 a, vec3 b) {
  IRAD_PRECISE float sum = a.x * b.x + a.y * b.y + a.z * b.z;
  return sum;
}
IRAD_FN vec3 preciseCross(vec3 a, vec3 b) {
  IRAD_PRECISE vec3 product =
      vec3(a.y, a.z, a.x) * vec3(b.z, b.x, b.y) - vec3(a.z, a.x, a.y) * vec3(b.y, b.z, b.x);
  return product;
}
IRAD_FN vec3 preciseNormalize(vec3 a) {
  IRAD_PRECISE vec3 unit = a * inversesqrt(preciseDot(a, a));
  return unit;
}

IRAD_END
#endif
