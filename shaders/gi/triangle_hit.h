// Watertight rays against triangles (Woop, Benthin and Wald 2013, "Watertight Ray/Triangle Intersection"): a ray that
// passes between two triangles with a common edge meets at least one of them. On the edge itself both count.
#ifndef IRAD_TRIANGLE_HIT_H
#define IRAD_TRIANGLE_HIT_H
#include "shared/surface.h"
IRAD_BEGIN

IRAD_FN uint triangleOf(UintArray pieces, uint piece) { return pieces.at[piece] & ~PIECE_SMALL; }

IRAD_FN Triangle triangleAt(Vec4Array corners, uint triangle) {
  Triangle t;
  t.a = vec3(corners.at[3u * triangle]);
  t.b = vec3(corners.at[3u * triangle + 1u]);
  t.c = vec3(corners.at[3u * triangle + 2u]);
  return t;
}

/// Read as a whole: Mesa 22.3 takes x for w where the rest of the vector has been read before.
IRAD_FN bool showsBack(Vec4Array corners, uint triangle) {
  vec4 first = corners.at[3u * triangle];
  return first.w > 0.0f;
}

IRAD_FN bool hasHoles(Vec4Array corners, uint triangle) {
  vec4 second = corners.at[3u * triangle + 1u];
  return second.w > 0.0f;
}

IRAD_FN bool isTinted(Vec4Array corners, uint triangle) {
  vec4 second = corners.at[3u * triangle + 1u];
  return second.w > 1.0f;
}

/// The triangle itself or, where it repeats another one, that: it alone has pieces.
IRAD_FN uint firstInPlace(Vec4Array corners, uint triangle) {
  vec4 third = corners.at[3u * triangle + 2u];
  return third.w > 0.0f ? uint(third.w) - 1u : triangle;
}

struct ShearedRay {
  vec3 origin;
  uint axis;   ///< along which the direction is longest
  vec3 shear;  ///< x, y: of the two other axes; z: 1 / direction along `axis`
};

IRAD_FN vec3 axisLast(vec3 v, uint axis) {
  return axis == 0u ? vec3(v.y, v.z, v.x) : (axis == 1u ? vec3(v.z, v.x, v.y) : v);
}

IRAD_FN ShearedRay shearedRay(vec3 origin, vec3 direction) {
  vec3 a = abs(direction);
  uint axis = a.x >= a.y && a.x >= a.z ? 0u : (a.y >= a.z ? 1u : 2u);
  vec3 d = axisLast(direction, axis);
  ShearedRay ray = {origin, axis, vec3(d.x / d.z, d.y / d.z, 1.0f / d.z)};
  return ray;
}

/// Whether the ray's line meets the triangle; `t`: where, in lengths of the direction; `front`: from in front of it.
/// Nothing here may be contracted: the two triangles of an edge must agree on it.
IRAD_FN bool meetsTriangle(ShearedRay ray, Triangle triangle, IRAD_INOUT(float) t, IRAD_INOUT(bool) front) {
  vec2 shear = vec2(ray.shear);
  IRAD_PRECISE vec3 a = axisLast(triangle.a - ray.origin, ray.axis);
  IRAD_PRECISE vec3 b = axisLast(triangle.b - ray.origin, ray.axis);
  IRAD_PRECISE vec3 c = axisLast(triangle.c - ray.origin, ray.axis);
  IRAD_PRECISE vec2 fa = vec2(a) - shear * a.z;
  IRAD_PRECISE vec2 fb = vec2(b) - shear * b.z;
  IRAD_PRECISE vec2 fc = vec2(c) - shear * c.z;
  IRAD_PRECISE float u = fc.x * fb.y - fc.y * fb.x;
  IRAD_PRECISE float v = fa.x * fc.y - fa.y * fc.x;
  IRAD_PRECISE float w = fb.x * fa.y - fb.y * fa.x;
  t = 0.0f;
  front = false;
  if (min(u, min(v, w)) < 0.0f && max(u, max(v, w)) > 0.0f) return false;
  float sum = u + v + w;
  if (sum == 0.0f) return false;
  t = (u * a.z + v * b.z + w * c.z) * ray.shear.z / sum;
  front = sum * ray.shear.z > 0.0f;
  return true;
}

IRAD_END
#endif
