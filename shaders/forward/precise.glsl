// Products whose order and rounding are as written in every variant of a shader. A driver may fuse the built-in ones,
// and may decide otherwise once a branch beside them is specialized away; but leaving out an effect that a scene does
// not have must not change a bit of the others. Their arguments have to be `precise` where they are computed: the
// qualifier does not pass through a call.
#ifndef IRAD_FORWARD_PRECISE_GLSL
#define IRAD_FORWARD_PRECISE_GLSL

float preciseDot(vec3 a, vec3 b) {
  precise float sum = a.x * b.x + a.y * b.y + a.z * b.z;
  return sum;
}
vec3 preciseCross(vec3 a, vec3 b) {
  precise vec3 product = a.yzx * b.zxy - a.zxy * b.yzx;
  return product;
}
vec3 preciseNormalize(vec3 a) {
  precise vec3 unit = a * inversesqrt(preciseDot(a, a));
  return unit;
}

#endif
