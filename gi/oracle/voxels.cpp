#include "gi/oracle/voxels.h"

#include <algorithm>
#include <cmath>

namespace irad::oracle {

Triangle toVoxels(const Grid& grid, const glm::vec3& a, const glm::vec3& b, const glm::vec3& c) {
  const auto convert = [&grid](const glm::vec3& p) { return glm::dvec3((p - grid.origin) * grid.inverseEdge); };
  return {convert(a), convert(b), convert(c)};
}

double coverBand(const Grid& grid) {
  return std::max({grid.dims.x, grid.dims.y, grid.dims.z}) * std::ldexp(1.0, -20);
}

Cover cover(const Triangle& triangle, glm::ivec3 cell, double band) {
  // Box axes, half-open: [cell, cell + 1).
  for (int a = 0; a < 3; ++a) {
    const double lo = std::min({triangle[0][a], triangle[1][a], triangle[2][a]});
    const double hi = std::max({triangle[0][a], triangle[1][a], triangle[2][a]});
    if (hi < cell[a] || lo >= cell[a] + 1) return Cover::No;
  }
  const glm::dvec3 centre = glm::dvec3(cell) + 0.5;
  bool sure = true;
  // Gap between the projections of the triangle and of the cell on a direction; false when it separates them for sure.
  const auto test = [&](const glm::dvec3& direction) {
    const double length = glm::length(direction);
    if (length < 1e-12) return true;
    const glm::dvec3 n = direction / length;
    // Directions along an axis were decided exactly above.
    if (std::max({std::abs(n.x), std::abs(n.y), std::abs(n.z)}) > 1 - 1e-15) return true;
    const double radius = 0.5 * (std::abs(n.x) + std::abs(n.y) + std::abs(n.z));
    double lo = 1e300, hi = -1e300;
    for (const glm::dvec3& v : triangle) {
      const double d = glm::dot(v - centre, n);
      lo = std::min(lo, d);
      hi = std::max(hi, d);
    }
    const double gap = std::max(lo - radius, -radius - hi);
    if (gap > -band) sure = false;
    return gap <= band;
  };
  const glm::dvec3 e[3] = {triangle[1] - triangle[0], triangle[2] - triangle[1], triangle[0] - triangle[2]};
  if (!test(glm::cross(e[0], e[1]))) return Cover::No;
  for (const glm::dvec3& edge : e)
    for (int a = 0; a < 3; ++a) {
      glm::dvec3 axis(0.0);
      axis[a] = 1.0;
      if (!test(glm::cross(edge, axis))) return Cover::No;
    }
  return sure ? Cover::Yes : Cover::Unsure;
}

namespace {
/// The part of a triangle inside a closed cell, as a fan of triangles about its first corner.
struct Part {
  double area = 0;
  glm::dvec3 sum{0.0};  ///< of the fan's middles, by area
};

Part partInside(const Triangle& triangle, const glm::ivec3& cell) {
  std::vector<glm::dvec3> polygon(triangle.begin(), triangle.end());
  for (int a = 0; a < 3; ++a)
    for (const double side : {1.0, -1.0}) {
      // Inside: side * p >= bound.
      const double bound = side > 0 ? cell[a] : -(cell[a] + 1.0);
      std::vector<glm::dvec3> kept;
      for (size_t i = 0; i < polygon.size(); ++i) {
        const glm::dvec3 &p = polygon[i], &q = polygon[(i + 1) % polygon.size()];
        const double dp = side * p[a] - bound, dq = side * q[a] - bound;
        if (dp >= 0) kept.push_back(p);
        if ((dp >= 0) != (dq >= 0)) kept.push_back(p + (q - p) * (dp / (dp - dq)));
      }
      polygon = kept;
      if (polygon.empty()) return {};
    }
  Part part;
  for (size_t i = 2; i < polygon.size(); ++i) {
    const double area = 0.5 * glm::length(glm::cross(polygon[i - 1] - polygon[0], polygon[i] - polygon[0]));
    part.area += area;
    part.sum += area / 3 * (polygon[0] + polygon[i - 1] + polygon[i]);
  }
  return part;
}
}  // namespace

double areaInside(const Triangle& triangle, glm::ivec3 cell) {
  return partInside(triangle, cell).area;
}

glm::dvec3 middleInside(const Triangle& triangle, glm::ivec3 cell) {
  const Part part = partInside(triangle, cell);
  return part.area > 1e-12 ? part.sum / part.area : (triangle[0] + triangle[1] + triangle[2]) / 3.0;
}

namespace {
/// Where the plane of a triangle, of normal n, crosses the middle line of a cell along `axis`.
double depthOnMiddle(const Triangle& t, const glm::dvec3& n, int axis, const glm::ivec3& cell) {
  const int u = (axis + 1) % 3, v = (axis + 2) % 3;
  return t[0][axis] - (n[u] * (cell[u] + 0.5 - t[0][u]) + n[v] * (cell[v] + 0.5 - t[0][v])) / n[axis];
}
}  // namespace

glm::dvec3 onMiddleLine(const Triangle& triangle, glm::ivec3 cell) {
  const glm::dvec3 n = glm::cross(triangle[1] - triangle[0], triangle[2] - triangle[0]), m = glm::abs(n);
  const int axis = m.x >= m.y && m.x >= m.z ? 0 : (m.y >= m.z ? 1 : 2);
  glm::dvec3 point = glm::dvec3(cell) + 0.5;
  point[axis] = depthOnMiddle(triangle, n, axis, cell);
  return point;
}

namespace {
/// The crossing, if the triangle itself has it.
struct Crossing {
  Cover cover = Cover::No;
  double front = 0;
};

Crossing crossMiddle(const Triangle& t, const glm::ivec3& cell) {
  constexpr double kDoubt = 2.5e-3;  // voxels; the shader's own slack is 1e-3
  Crossing best;
  const glm::dvec3 n = glm::cross(t[1] - t[0], t[2] - t[0]), m = glm::abs(n);
  const double largest = std::max({m.x, m.y, m.z});
  if (largest == 0) return best;
  for (int axis = 0; axis < 3; ++axis) {
    if (m[axis] < largest * (1 - 1e-4)) continue;
    const int u = (axis + 1) % 3, v = (axis + 2) % 3;
    const bool tie = std::count_if(&m.x, &m.x + 3, [&](double a) { return a >= largest * (1 - 1e-4); }) > 1;
    double inside = 1e9;  // distance to the nearest edge, positive inside
    for (int i = 0; i < 3; ++i) {
      const glm::dvec3 &a = t[i], &b = t[(i + 1) % 3];
      const glm::dvec2 inward = glm::dvec2(a[v] - b[v], b[u] - a[u]) * (n[axis] >= 0 ? 1.0 : -1.0);
      const double e = inward.x * (cell[u] + 0.5 - a[u]) + inward.y * (cell[v] + 0.5 - a[v]);
      inside = std::min(inside, e / (std::abs(inward.x) + std::abs(inward.y)));
    }
    const double depth = depthOnMiddle(t, n, axis, cell) - cell[axis];
    const double within = std::min({inside, depth, 1 - depth});
    if (within < -kDoubt) continue;
    const Cover cover = within < kDoubt || tie ? Cover::Unsure : Cover::Yes;
    if (cover <= best.cover) continue;
    best = {cover, (depth - 0.5) * n[axis] / glm::length(n)};
  }
  return best;
}
}  // namespace

Coverage voxelize(const Grid& grid, const std::vector<glm::vec3>& positions, const std::vector<uint32_t>& indices) {
  Coverage result{std::vector<Cover>(grid.voxels, Cover::No), std::vector<double>(grid.voxels, 0.0),
                  std::vector<double>(grid.voxels, -1.0), std::vector<double>(grid.voxels, -1.0)};
  const double band = coverBand(grid);
  for (size_t i = 0; i + 2 < indices.size(); i += 3) {
    const Triangle t = toVoxels(grid, positions[indices[i]], positions[indices[i + 1]], positions[indices[i + 2]]);
    const glm::ivec3 lo(glm::floor(glm::min(t[0], glm::min(t[1], t[2]))));
    const glm::ivec3 hi(glm::floor(glm::max(t[0], glm::max(t[1], t[2]))));
    for (int z = lo.z; z <= hi.z; ++z)
      for (int y = lo.y; y <= hi.y; ++y)
        for (int x = lo.x; x <= hi.x; ++x) {
          const uint32_t voxel = voxelIndex(glm::uvec3(x, y, z), grid.dims);
          const Cover c = cover(t, {x, y, z}, band);
          result.cover[voxel] = std::max(result.cover[voxel], c);
          if (c != Cover::No) result.area[voxel] = std::max(result.area[voxel], areaInside(t, {x, y, z}));
          const Crossing crossing = crossMiddle(t, {x, y, z});
          if (crossing.cover == Cover::No) continue;
          result.possibleFront[voxel] = std::max(result.possibleFront[voxel], crossing.front);
          if (crossing.cover == Cover::Yes) result.sureFront[voxel] = std::max(result.sureFront[voxel], crossing.front);
        }
  }
  return result;
}

std::vector<bool> floodFill(const Grid& grid, const std::vector<bool>& solid, glm::uvec3 start) {
  std::vector<bool> reached(grid.voxels, false);
  std::vector<glm::uvec3> open{start};
  reached[voxelIndex(start, grid.dims)] = true;
  while (!open.empty()) {
    const glm::uvec3 at = open.back();
    open.pop_back();
    for (int a = 0; a < 3; ++a)
      for (const int step : {-1, 1}) {
        glm::ivec3 next(at);
        next[a] += step;
        if (next[a] < 0 || next[a] >= static_cast<int>(grid.dims[a])) continue;
        const uint32_t voxel = voxelIndex(glm::uvec3(next), grid.dims);
        if (solid[voxel] || reached[voxel]) continue;
        reached[voxel] = true;
        open.push_back(glm::uvec3(next));
      }
  }
  return reached;
}

}  // namespace irad::oracle
