// Watertight rays against triangles (Woop, Benthin and Wald 2013, "Watertight Ray/Triangle Intersection"): a ray that
// passes between two triangles with a common edge meets at least one of them. On the edge itself both count.
#ifndef IRAD_TRIANGLE_HIT_GLSL
#define IRAD_TRIANGLE_HIT_GLSL
#include "shared/surface.h"

uint triangleOf(UintArray pieces, uint piece) { return pieces.at[piece] & ~PIECE_SMALL; }

Triangle triangleAt(Vec4Array corners, uint triangle) {
  return Triangle(corners.at[3u * triangle].xyz, corners.at[3u * triangle + 1u].xyz, corners.at[3u * triangle + 2u].xyz);
}

/// Read as a whole: Mesa 22.3 takes x for w where the rest of the vector has been read before.
bool showsBack(Vec4Array corners, uint triangle) {
  vec4 first = corners.at[3u * triangle];
  return first.w > 0.0;
}

bool hasHoles(Vec4Array corners, uint triangle) {
  vec4 second = corners.at[3u * triangle + 1u];
  return second.w > 0.0;
}

bool isTinted(Vec4Array corners, uint triangle) {
  vec4 second = corners.at[3u * triangle + 1u];
  return second.w > 1.0;
}

/// The triangle itself or, where it repeats another one, that: it alone has pieces.
uint firstInPlace(Vec4Array corners, uint triangle) {
  vec4 third = corners.at[3u * triangle + 2u];
  return third.w > 0.0 ? uint(third.w) - 1u : triangle;
}

struct ShearedRay {
  vec3 origin;
  uint axis;   ///< along which the direction is longest
  vec3 shear;  ///< x, y: of the two other axes; z: 1 / direction along `axis`
};

vec3 axisLast(vec3 v, uint axis) { return axis == 0u ? v.yzx : (axis == 1u ? v.zxy : v); }

ShearedRay shearedRay(vec3 origin, vec3 direction) {
  vec3 a = abs(direction);
  uint axis = a.x >= a.y && a.x >= a.z ? 0u : (a.y >= a.z ? 1u : 2u);
  vec3 d = axisLast(direction, axis);
  return ShearedRay(origin, axis, vec3(d.x / d.z, d.y / d.z, 1.0f / d.z));
}

/// Whether the ray's line meets the triangle; `t`: where, in lengths of the direction; `front`: from in front of it.
/// Nothing here may be contracted: the two triangles of an edge must agree on it.
bool meetsTriangle(ShearedRay ray, Triangle triangle, out float t, out bool front) {
  precise vec3 a = axisLast(triangle.a - ray.origin, ray.axis);
  precise vec3 b = axisLast(triangle.b - ray.origin, ray.axis);
  precise vec3 c = axisLast(triangle.c - ray.origin, ray.axis);
  precise vec2 fa = a.xy - ray.shear.xy * a.z;
  precise vec2 fb = b.xy - ray.shear.xy * b.z;
  precise vec2 fc = c.xy - ray.shear.xy * c.z;
  precise float u = fc.x * fb.y - fc.y * fb.x;
  precise float v = fa.x * fc.y - fa.y * fc.x;
  precise float w = fb.x * fa.y - fb.y * fa.x;
  t = 0.0f;
  front = false;
  if (min(u, min(v, w)) < 0.0f && max(u, max(v, w)) > 0.0f) return false;
  float sum = u + v + w;
  if (sum == 0.0f) return false;
  t = (u * a.z + v * b.z + w * c.z) * ray.shear.z / sum;
  front = sum * ray.shear.z > 0.0f;
  return true;
}

#endif
