// The part of a triangle inside a cell (Sutherland and Hodgman 1974, "Reentrant Polygon Clipping"), in workgroups of 64.
#ifndef IRAD_VOXEL_CLIP_H
#define IRAD_VOXEL_CLIP_H
#ifndef __cplusplus
#extension GL_EXT_control_flow_attributes : require
#endif
#include "shared/constants.h"
#include "shared/types.h"

#ifdef __cplusplus
#define IRAD_DONT_UNROLL
#define IRAD_UNROLL
namespace irad {
inline thread_local vec3 clipCorners[2 * 9];
IRAD_FN vec3 clipCorner(uint polygon, uint i) { return clipCorners[polygon * 9u + i]; }
IRAD_FN void setClipCorner(uint polygon, uint i, vec3 corner) { clipCorners[polygon * 9u + i] = corner; }
}  // namespace irad
#else
#define IRAD_DONT_UNROLL [[dont_unroll]]
#define IRAD_UNROLL [[unroll]]

/// Two polygons of up to nine corners per invocation. Of its own, on GPUs: 13.5 KiB of shared memory for a workgroup leave
/// half of the invocations out that fit otherwise. On lavapipe arrays with computed indices become ladders of branches (2 s
/// to compile instead of .4 s), but for those in shared memory.
layout(constant_id = CONSTANT_CLIPS_SHARED) const bool CLIPS_SHARED = true;
const uint CLIP_CORNERS = 2u * 9u;
shared vec3 clipShared[CLIPS_SHARED ? CLIP_CORNERS * 64u : 1u];
vec3 clipOwn[CLIPS_SHARED ? 1u : CLIP_CORNERS];

/// Corner i of one of the two polygons.
vec3 clipCorner(uint polygon, uint i) {
  uint place = polygon * 9u + i;
  return CLIPS_SHARED ? clipShared[place * 64u + gl_LocalInvocationIndex] : clipOwn[place];
}
void setClipCorner(uint polygon, uint i, vec3 corner) {
  uint place = polygon * 9u + i;
  if (CLIPS_SHARED) clipShared[place * 64u + gl_LocalInvocationIndex] = corner;
  else clipOwn[place] = corner;
}

#endif

IRAD_BEGIN

/// a, b, c are relative to the cell's lower corner; the cell is larger by `slack` on all sides. Returns how many corners
/// the triangle's part in it has, 0 where there is none; they are clipCorner(from, i).
IRAD_FN uint clipPolygon(vec3 a, vec3 b, vec3 c, float slack, IRAD_INOUT(uint) from) {
  from = 0u;
  uint n = 3u;
  setClipCorner(from, 0u, a);
  setClipCorner(from, 1u, b);
  setClipCorner(from, 2u, c);
  vec3 lo = min(a, min(b, c));
  vec3 hi = max(a, max(b, c));
  IRAD_DONT_UNROLL for (uint plane = 0u; plane < 6u; ++plane) {
    // p . axis >= 0 or, mirrored, p . axis <= 1.
    uint k = plane >> 1;
    bool upper = (plane & 1u) != 0u;
    vec3 axis = vec3(k == 0u ? 1.0f : 0.0f, k == 1u ? 1.0f : 0.0f, k == 2u ? 1.0f : 0.0f) * (upper ? -1.0f : 1.0f);
    float base = (upper ? 1.0f : 0.0f) + slack;
    if (base + min(dot(lo, axis), dot(hi, axis)) >= 0.0f) continue;  // the whole triangle is inside
    uint m = 0u;
    vec3 previous = clipCorner(from, n - 1u);
    float dp = base + dot(previous, axis);
    IRAD_DONT_UNROLL for (uint i = 0u; i < n; ++i) {
      vec3 current = clipCorner(from, i);
      float dc = base + dot(current, axis);
      if ((dp >= 0.0f) != (dc >= 0.0f) && m < 9u)
        setClipCorner(1u - from, m++, previous + (current - previous) * (dp / (dp - dc)));
      if (dc >= 0.0f && m < 9u) setClipCorner(1u - from, m++, current);
      previous = current;
      dp = dc;
    }
    if (m == 0u) return 0u;
    from = 1u - from;
    n = m;
  }
  return n;
}

/// The area of the polygon, and its centre: a fan of triangles about the first corner.
IRAD_FN float polygonArea(uint from, uint n, IRAD_INOUT(vec3) centre) {
  float area = 0.0f;
  vec3 weighted = vec3(0.0f);
  vec3 first = clipCorner(from, 0u);
  vec3 previous = first;
  vec3 sum = first;
  IRAD_DONT_UNROLL for (uint i = 1u; i < n; ++i) {
    vec3 current = clipCorner(from, i);
    vec3 d = previous - first;
    vec3 e = current - first;
    float fan = 0.5f * length(cross(d, e));
    area += fan;
    weighted += fan * (d + e);
    sum += current;
    previous = current;
  }
  centre = area > 1e-12f ? first + weighted * (1.0f / (3.0f * area)) : sum / float(n);
  return area;
}

/// The area of the triangle's part in the cell, or -1 where there is none; `centre` is that part's, relative to the corner.
IRAD_FN float clipToCell(vec3 a, vec3 b, vec3 c, IRAD_INOUT(vec3) centre) {
  uint from;
  uint n = clipPolygon(a, b, c, 0.0f, from);
  centre = (a + b + c) * (1.0f / 3.0f);
  return n == 0u ? -1.0f : polygonArea(from, n, centre);
}

IRAD_END
#endif
