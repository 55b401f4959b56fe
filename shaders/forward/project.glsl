// Local position to clip space by one fixed sequence of operations (`precise`: no contraction), so that the forward pass's
// depths equal the prepass's.
#ifndef IRAD_FORWARD_PROJECT_GLSL
#define IRAD_FORWARD_PROJECT_GLSL

vec4 project(mat4 m, vec3 p) {
  precise vec4 x = m[0] * p.x;
  precise vec4 xy = x + m[1] * p.y;
  precise vec4 xyz = xy + m[2] * p.z;
  precise vec4 clip = xyz + m[3];
  return clip;
}
/// A direction likewise: without the translation.
vec4 projectDirection(mat4 m, vec3 d) {
  precise vec4 clip = m[0] * d.x + m[1] * d.y + m[2] * d.z;
  return clip;
}

#endif
