// The part of a triangle inside a cell (Sutherland and Hodgman 1974, "Reentrant Polygon Clipping").
// a, b, c are relative to the cell's lower corner. Returns the area, or -1 where nothing of the triangle is in the cell;
// `centre` is that part's, relative to the corner.
float clipToCell(vec3 a, vec3 b, vec3 c, out vec3 centre) {
  vec3 polygon[9];
  vec3 clipped[9];
  polygon[0] = a;
  polygon[1] = b;
  polygon[2] = c;
  uint n = 3u;
  centre = (a + b + c) * (1.0 / 3.0);
  vec3 lo = min(a, min(b, c));
  vec3 hi = max(a, max(b, c));
  for (uint plane = 0u; plane < 6u; ++plane) {
    uint axis = plane >> 1;
    bool upper = (plane & 1u) != 0u;
    // Skip planes that the whole triangle is inside of.
    if (upper ? hi[axis] <= 1.0 : lo[axis] >= 0.0) continue;
    uint m = 0u;
    vec3 previous = polygon[n - 1u];
    float dp = upper ? 1.0 - previous[axis] : previous[axis];
    for (uint i = 0u; i < n; ++i) {
      vec3 current = polygon[i];
      float dc = upper ? 1.0 - current[axis] : current[axis];
      if ((dp >= 0.0) != (dc >= 0.0) && m < 9u) clipped[m++] = previous + (current - previous) * (dp / (dp - dc));
      if (dc >= 0.0 && m < 9u) clipped[m++] = current;
      previous = current;
      dp = dc;
    }
    if (m == 0u) return -1.0;
    for (uint i = 0u; i < m; ++i) polygon[i] = clipped[i];
    n = m;
  }
  // Fan of triangles about the first corner.
  float area = 0.0;
  vec3 weighted = vec3(0.0);
  vec3 mean = polygon[0];
  for (uint i = 1u; i < n; ++i) mean += polygon[i];
  for (uint i = 2u; i < n; ++i) {
    vec3 d = polygon[i - 1u] - polygon[0];
    vec3 e = polygon[i] - polygon[0];
    float fan = 0.5 * length(cross(d, e));
    area += fan;
    weighted += fan * (d + e);
  }
  centre = area > 1e-12 ? polygon[0] + weighted * (1.0 / (3.0 * area)) : mean / float(n);
  return area;
}
