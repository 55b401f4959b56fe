// The cells along a ray, for the oracle's hit rules.
#pragma once

#include <algorithm>
#include <array>
#include <limits>
#include <numeric>

#include "gi/oracle/rays.h"

namespace irad::oracle {

/// The cells along a ray: all of them, or those that a distance field leaves.
struct Walk {
  Walk(const Facets& in, const Ray& along, const Passage& by)
      : facets(in), ray(along), passage(by), cell(glm::floor(along.origin)) {
    arrive();
  }
  const Facets& facets;
  const Ray& ray;
  const Passage& passage;
  glm::ivec3 cell;
  double enter = 0, leave = 0;
  double margin = 1e9;  ///< least gap between two exits of the cells left so far: a tie of axes

  void arrive() {
    leave = exits(1)[0].first;
    if (passage.steps) passage.steps->push_back({cell, enter});
  }
  /// Where the ray leaves the cube of cells within k - 1 of its own, by axis, nearest first.
  std::array<std::pair<double, int>, 3> exits(int k) const {
    std::array<std::pair<double, int>, 3> t;
    for (int a = 0; a < 3; ++a) {
      const double bound = cell[a] + (ray.direction[a] > 0 ? k : 1 - k);
      t[a] = {
          ray.direction[a] == 0 ? std::numeric_limits<double>::infinity() : (bound - ray.origin[a]) / ray.direction[a],
          a};
    }
    std::sort(t.begin(), t.end());
    return t;
  }
  /// Goes on from a cell of the grid.
  void next() {
    const float empty = passage.field ? passage.field->voxels[voxelIndex(glm::uvec3(cell), facets.grid.dims)] : 0.0f;
    if (empty > 0 && passage.field->euclidean) {
      enter += double{empty};
      cell = glm::floor(ray.origin + enter * ray.direction);
    } else {
      const int k = std::max(1, static_cast<int>(empty));
      const auto sorted = exits(k);
      margin = std::min(margin, sorted[1].first - sorted[0].first);
      const int axis = sorted[0].second;
      enter = sorted[0].first;
      const int beyond = cell[axis] + (ray.direction[axis] > 0 ? k : -k);
      cell = glm::clamp(glm::ivec3(glm::floor(ray.origin + enter * ray.direction)), cell - (k - 1), cell + (k - 1));
      cell[axis] = beyond;
    }
    arrive();
  }
};

inline std::vector<uint32_t> facetsAt(const Facets& f, const glm::ivec3& cell) {
  for (int a = 0; a < 3; ++a)
    if (cell[a] < 0 || cell[a] >= static_cast<int>(f.grid.dims[a])) return {};
  const uint32_t entry = f.reverse[voxelIndex(glm::uvec3(cell), f.grid.dims)];
  if (entry == NO_FACET) return {};
  std::vector<uint32_t> facets(facetsOf(entry));
  std::iota(facets.begin(), facets.end(), firstFacet(entry));
  return facets;
}

inline bool inside(const Facets& f, const glm::ivec3& cell) {
  for (int a = 0; a < 3; ++a)
    if (cell[a] < 0 || cell[a] >= static_cast<int>(f.grid.dims[a])) return false;
  return true;
}

/// Hit rule `triangles`.
Hit traceTriangles(const Facets& facets, const Ray& ray, const Passage& passage);

}  // namespace irad::oracle
