// The part of a triangle inside a cell (Sutherland and Hodgman 1974, "Reentrant Polygon Clipping"), in workgroups of 64.
#extension GL_EXT_control_flow_attributes : require

/// Two polygons of up to nine corners per invocation. In shared memory, because a private array with computed indices is
/// spilled on a GPU and becomes a ladder of branches on lavapipe (2 s to compile instead of .4 s).
shared vec3 clipCorners[2u * 9u * 64u];
uint clipPlace(uint polygon, uint corner) { return (polygon * 9u + corner) * 64u + gl_LocalInvocationIndex; }

/// a, b, c are relative to the cell's lower corner; the cell is larger by `slack` on all sides. Returns how many corners
/// the triangle's part in it has, 0 where there is none; they are at clipPlace(from, i).
uint clipPolygon(vec3 a, vec3 b, vec3 c, float slack, out uint from) {
  from = 0u;
  uint n = 3u;
  clipCorners[clipPlace(from, 0u)] = a;
  clipCorners[clipPlace(from, 1u)] = b;
  clipCorners[clipPlace(from, 2u)] = c;
  vec3 lo = min(a, min(b, c));
  vec3 hi = max(a, max(b, c));
  [[dont_unroll]] for (uint plane = 0u; plane < 6u; ++plane) {
    // p . axis >= 0 or, mirrored, p . axis <= 1.
    uint k = plane >> 1;
    bool upper = (plane & 1u) != 0u;
    vec3 axis = vec3(k == 0u ? 1.0 : 0.0, k == 1u ? 1.0 : 0.0, k == 2u ? 1.0 : 0.0) * (upper ? -1.0 : 1.0);
    float base = (upper ? 1.0 : 0.0) + slack;
    if (base + min(dot(lo, axis), dot(hi, axis)) >= 0.0) continue;  // the whole triangle is inside
    uint m = 0u;
    vec3 previous = clipCorners[clipPlace(from, n - 1u)];
    float dp = base + dot(previous, axis);
    [[dont_unroll]] for (uint i = 0u; i < n; ++i) {
      vec3 current = clipCorners[clipPlace(from, i)];
      float dc = base + dot(current, axis);
      if ((dp >= 0.0) != (dc >= 0.0) && m < 9u)
        clipCorners[clipPlace(1u - from, m++)] = previous + (current - previous) * (dp / (dp - dc));
      if (dc >= 0.0 && m < 9u) clipCorners[clipPlace(1u - from, m++)] = current;
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
float polygonArea(uint from, uint n, out vec3 centre) {
  float area = 0.0;
  vec3 weighted = vec3(0.0);
  vec3 first = clipCorners[clipPlace(from, 0u)];
  vec3 previous = first;
  vec3 sum = first;
  [[dont_unroll]] for (uint i = 1u; i < n; ++i) {
    vec3 current = clipCorners[clipPlace(from, i)];
    vec3 d = previous - first;
    vec3 e = current - first;
    float fan = 0.5 * length(cross(d, e));
    area += fan;
    weighted += fan * (d + e);
    sum += current;
    previous = current;
  }
  centre = area > 1e-12 ? first + weighted * (1.0 / (3.0 * area)) : sum / float(n);
  return area;
}

/// The area of the triangle's part in the cell, or -1 where there is none; `centre` is that part's, relative to the corner.
float clipToCell(vec3 a, vec3 b, vec3 c, out vec3 centre) {
  uint from;
  uint n = clipPolygon(a, b, c, 0.0, from);
  centre = (a + b + c) * (1.0 / 3.0);
  return n == 0u ? -1.0 : polygonArea(from, n, centre);
}
