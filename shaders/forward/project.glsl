// Local position to clip space by one fixed sequence of operations (`precise`: no contraction), so that the forward pass's
// depths equal the prepass's.
vec4 project(mat4 m, vec3 p) {
  precise vec4 x = m[0] * p.x;
  precise vec4 xy = x + m[1] * p.y;
  precise vec4 xyz = xy + m[2] * p.z;
  precise vec4 clip = xyz + m[3];
  return clip;
}
