// Hit rule `triangles` in double precision: every cell's triangles, one after the other.
#include <cmath>

#include "gi/oracle/walk.h"
#include "shaders/shared/trace.h"

namespace irad::oracle {
namespace {

using glm::dvec3;

struct Meeting {
  double t = 0;
  bool front = false;
  double edge = 0;  ///< least weight of a corner: how close to an edge
};

/// Where a line meets a triangle (Moller and Trumbore 1997, "Fast, Minimum Storage Ray/Triangle Intersection").
std::optional<Meeting> meet(const Facets& facets, uint32_t triangle, const Ray& ray) {
  const dvec3 a = facets.corner(triangle, 0), b = facets.corner(triangle, 1) - a, c = facets.corner(triangle, 2) - a;
  const dvec3 p = glm::cross(ray.direction, c);
  const double determinant = glm::dot(b, p);
  if (determinant == 0) return std::nullopt;
  const dvec3 from = ray.origin - a;
  const double u = glm::dot(from, p) / determinant;
  const dvec3 q = glm::cross(from, b);
  const double v = glm::dot(ray.direction, q) / determinant;
  const double least = std::min({u, v, 1 - u - v});
  if (least < 0) return std::nullopt;
  return Meeting{glm::dot(c, q) / determinant, determinant > 0, least};
}

}  // namespace

Hit traceTriangles(const Facets& facets, const Ray& ray, const Passage& passage) {
  Hit hit{TRACE_ESCAPED};
  double nearest = std::numeric_limits<double>::infinity();
  uint32_t met = kNoTriangle, metPiece = 0, metFirst = 0;
  Meeting found;
  Walk walk(facets, ray, passage);
  for (; inside(facets, walk.cell) && nearest > walk.enter; walk.next()) {
    const std::vector<uint32_t> here = facetsAt(facets, walk.cell);
    if (here.empty()) continue;
    for (uint32_t i = facets.firstPiece.at(here.front()); i < facets.firstPiece.at(here.back() + 1); ++i) {
      const uint32_t triangle = facets.pieces.at(i);
      if (triangle == ray.triangle) continue;
      const std::optional<Meeting> m = meet(facets, triangle, ray);
      if (!m || m->t <= 0 || m->t > nearest || (m->t == nearest && triangle > met)) continue;
      hit.margin = std::min(hit.margin, triangle == met ? 1e9 : std::abs(nearest - m->t));
      nearest = m->t;
      met = triangle;
      metPiece = i;
      metFirst = here.front();
      found = *m;
    }
    if (nearest <= walk.leave) break;
  }
  hit.margin = std::min(hit.margin, walk.margin);
  if (met == kNoTriangle) return hit;
  hit.t = nearest;
  hit.margin = std::min(hit.margin, found.edge);
  const uint32_t side = found.front ? facets.sides.at(metPiece) & 0xFFFFu : facets.sides.at(metPiece) >> 16;
  hit.facet = side == PIECE_BLACK ? TRACE_BLOCKED : metFirst + side;
  if (side == PIECE_SPLIT) {  // which of the facets is the device's to say
    hit.facet = metFirst;
    hit.margin = 0;
  }
  return hit;
}

}  // namespace irad::oracle
