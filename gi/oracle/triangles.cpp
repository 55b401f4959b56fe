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
  double counts = 0;  ///< at which t it counts as met: later where nothing is seen (backDelay)
  double edge = 0;    ///< least weight of a corner: how close to an edge
};

/// Where a line meets a triangle, or its plane by no more than `beside` of a corner's weight outside an edge (Moller
/// and Trumbore 1997, "Fast, Minimum Storage Ray/Triangle Intersection").
std::optional<Meeting> meet(const Facets& facets, uint32_t triangle, const Ray& ray, double beside = 0) {
  const dvec3 a = facets.corner(triangle, 0), b = facets.corner(triangle, 1) - a, c = facets.corner(triangle, 2) - a;
  const dvec3 p = glm::cross(ray.direction, c);
  const double determinant = glm::dot(b, p);
  if (determinant == 0) return std::nullopt;
  const dvec3 from = ray.origin - a;
  const double u = glm::dot(from, p) / determinant;
  const dvec3 q = glm::cross(from, b);
  const double v = glm::dot(ray.direction, q) / determinant;
  const double least = std::min({u, v, 1 - u - v});
  if (least < -beside) return std::nullopt;
  const double t = glm::dot(c, q) / determinant;
  const bool front = determinant > 0;
  if (front || facets.showsBack(triangle)) return Meeting{t, front, t, least};
  const auto cosine = static_cast<float>(glm::dot(glm::normalize(glm::cross(b, c)), ray.direction));
  return Meeting{t, front, t + double{backDelay(facets.grid.dims, cosine)}, least};
}

/// gi/piece_cuts.h.
uint32_t classAt(const Facets& facets, uint32_t piece, bool back, const dvec3& at, double& margin) {
  const uint32_t sides = facets.sides.at(piece), shift = back ? 8 : 0;
  if ((sides & PIECE_CUT) == 0) return (sides >> shift) & 0xFFu;
  const Facets::Cuts cuts = facets.cutsOf(piece);
  uint32_t part = 0;
  bool cut = false;
  for (uint32_t i = 0; i < cuts.triangles.size(); ++i) {
    const uint32_t t = cuts.triangles[i];
    const dvec3 a = facets.corner(t, 0);
    const dvec3 normal = glm::cross(facets.corner(t, 1) - a, facets.corner(t, 2) - a);
    const double side = glm::dot(glm::normalize(normal), at - a);
    margin = std::min(margin, std::abs(std::abs(side) - CUT_WIDTH));
    cut = cut || std::abs(side) < CUT_WIDTH;
    part |= side > 0 ? 1u << i : 0u;
  }
  return cut ? PIECE_UNKNOWN : cuts.facet(part, back);
}

/// Whether a mask leaves a piece at a point relative to its voxel's lower corner.
bool isThere(const Facets& facets, uint32_t piece, uint32_t triangle, const dvec3& point, double& margin) {
  const dvec3 a = facets.corner(triangle, 0);
  const glm::vec3 normal(glm::cross(facets.corner(triangle, 1) - a, facets.corner(triangle, 2) - a));
  const glm::dvec2 at = glm::dvec2(seenAt(glm::vec3(point), seenAlong(normal))) * double{MASK_EDGE};
  for (int i = 0; i < 2; ++i) margin = std::min(margin, std::abs(at[i] - std::round(at[i])) / double{MASK_EDGE});
  return facets.maskLeaves(piece, maskBit(normal, glm::vec3(point)));
}

}  // namespace

First firstOfAll(const Facets& facets, const Ray& ray) {
  constexpr double kBeside = 1e-6;  // what passes an edge by so little is found, too, for its `edge` to say so
  First first{.t = std::numeric_limits<double>::infinity(), .edge = 1};
  for (uint32_t t = 0; t < facets.corners.size() / 3; ++t) {
    if (t == ray.triangle) continue;
    const std::optional<Meeting> m = meet(facets, t, ray, kBeside);
    if (m && m->t > 0 && m->t < first.t) first = {t, m->t, std::abs(m->edge)};
  }
  return first;
}

Hit traceTriangles(const Facets& facets, const Ray& ray, const Passage& passage) {
  Hit hit{TRACE_ESCAPED};
  double nearest = std::numeric_limits<double>::infinity(), second = nearest;  // along the ray; of another triangle
  uint32_t met = kNoTriangle, metPiece = 0, metFirst = 0;
  Meeting found;
  Walk walk(facets, ray, passage);
  for (; inside(facets, walk.cell) && nearest > walk.enter; walk.next()) {
    const std::vector<uint32_t> here = facetsAt(facets, walk.cell);
    if (here.empty()) continue;
    for (uint32_t i = facets.firstPiece.at(here.front()); i < facets.firstPiece.at(here.back() + 1); ++i) {
      const uint32_t triangle = facets.pieces.at(i) & ~PIECE_SMALL;
      if (triangle == ray.triangle) continue;
      const std::optional<Meeting> m = meet(facets, triangle, ray);
      if (!m) continue;
      hit.margin = std::min(hit.margin, std::abs(m->t));
      if (m->t <= 0) continue;
      if (facets.hasHoles(triangle)) {  // it is there only where this cell's piece is
        hit.margin = std::min({hit.margin, std::abs(m->t - walk.enter), std::abs(m->t - walk.leave)});
        if (m->t < walk.enter || m->t > walk.leave) continue;
        if (!isThere(facets, i, triangle, ray.origin + m->t * ray.direction - dvec3(walk.cell), hit.margin)) continue;
      }
      if (triangle != met) second = std::min(second, std::max(nearest, m->counts));
      if (m->counts > nearest || (m->counts == nearest && triangle > met)) continue;
      nearest = m->counts;
      met = triangle;
      metPiece = i;
      metFirst = here.front();
      found = *m;
    }
    if (nearest <= walk.leave) break;
  }
  hit.margin = std::min(hit.margin, walk.margin);
  if (met == kNoTriangle) return hit;
  hit.t = found.t;
  hit.margin = std::min({hit.margin, found.edge, second - nearest});
  const uint32_t side = classAt(facets, metPiece, !found.front, ray.origin + hit.t * ray.direction, hit.margin);
  hit.facet = side < PIECE_UNKNOWN ? metFirst + side : (side == PIECE_BLACK ? TRACE_BLOCKED : TRACE_INVALID);
  return hit;
}

}  // namespace irad::oracle
