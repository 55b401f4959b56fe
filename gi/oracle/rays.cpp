#include "gi/oracle/rays.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>

#include "gi/oracle/walk.h"
#include "shaders/shared/normals.h"
#include "shaders/shared/sampling.h"
#include "shaders/shared/trace.h"

namespace irad::oracle {
namespace {

using glm::dvec3, glm::ivec3;

Hit traceThesis(const Facets& facets, const Ray& ray, const Passage& passage) {
  Hit hit{TRACE_ESCAPED};
  Walk walk(facets, ray, passage);
  for (; inside(facets, walk.cell); walk.next()) {
    double least = 1;
    uint32_t best = TRACE_ESCAPED;
    for (const uint32_t f : facetsAt(facets, walk.cell)) {
      const double slope = glm::dot(facets.normal(f), ray.direction);
      if (best != TRACE_ESCAPED) hit.margin = std::min(hit.margin, std::abs(slope - least));
      if (slope < least) {
        least = slope;
        best = f;
      }
    }
    if (best == TRACE_ESCAPED) continue;
    hit.margin = std::min(hit.margin, std::abs(least));
    if (least < 0) {
      hit.facet = best;
      hit.t = walk.enter;
      break;
    }
  }
  hit.margin = std::min(hit.margin, walk.margin);
  return hit;
}

/// The faces that `around` of a facet in a voxel names.
std::vector<uint32_t> facetsAround(const Facets& facets, const ivec3& voxel, uint32_t around) {
  std::vector<uint32_t> list;
  for (around &= AROUND_VOXELS; around != 0; around &= around - 1) {
    const int i = std::countr_zero(around);
    for (const uint32_t f : facetsAt(facets, voxel + ivec3(i % 3, i / 3 % 3, i / 9) - 1)) list.push_back(f);
  }
  return list;
}

/// Whether a corner's face has ended before `crossing`, a point of its plane in its cell.
template <class Less>
bool cutOff(const Facets& facets, uint32_t facet, const dvec3& crossing, const Less& less) {
  if ((facets.shape[facet] & FACET_CORNER) == 0) return false;
  const uint32_t around = facets.around[facet] & AROUND_VOXELS;
  uint32_t left = around, convex = facets.around[facet] >> AROUND_CONVEX_SHIFT;
  for (; convex != 0; convex >>= 1, left &= left - 1) {
    if ((convex & 1) == 0) continue;
    for (const uint32_t f : facetsAround(facets, ivec3(unpackVoxel(facets.voxel[facet])), left & (~left + 1)))
      if (glm::dot(facets.normal(f), facets.normal(facet)) < TRACE_OWN_NORMAL)
        if (less(TRACE_ON_PLANE, facets.distance(f, crossing))) return true;
  }
  return false;
}

/// The middle of the facet that a ray leaves, else its origin.
dvec3 ownMiddle(const Facets& facets, const Ray& ray) {
  return ray.facet != NO_FACET ? facets.middle(ray.facet) : ray.origin;
}

/// Whether the ray starts behind a face: where the planes are too uncertain to tell, on the side of its facet's middle.
template <class Less>
bool startsBehind(const Facets& facets, const Ray& ray, uint32_t face, const Less& less) {
  const double start = facets.distance(face, ray.origin);
  return less(start, -TRACE_BEHIND) ||
         (less(start, TRACE_BEHIND) && less(facets.distance(face, ownMiddle(facets, ray)), -TRACE_BEHIND));
}

/// Whether the ray's origin lies beyond a wall that meets its facet's surface.
template <class Less>
bool startsInside(const Facets& facets, const Ray& ray, const Less& less) {
  if ((facets.shape[ray.facet] & FACET_CORNER) == 0) return false;
  const uint32_t around = facets.around[ray.facet];
  std::vector<uint32_t> near, walls;  // faces around, and those of them that do not meet the own one convexly
  uint32_t place = 0;
  for (uint32_t left = around & AROUND_VOXELS; left != 0; left &= left - 1, ++place)
    for (const uint32_t f : facetsAround(facets, ivec3(unpackVoxel(facets.voxel[ray.facet])), left & (~left + 1))) {
      if (f == ray.facet) continue;
      near.push_back(f);
      if (place >= 5 || !(around >> (AROUND_CONVEX_SHIFT + place) & 1)) walls.push_back(f);
    }
  return std::any_of(walls.begin(), walls.end(), [&](uint32_t wall) {
    return startsBehind(facets, ray, wall, less) &&
           !less(glm::dot(ray.normal, facets.middle(wall) - ray.origin), TRACE_CONCAVE) &&
           !less(TRACE_OWN_NORMAL, glm::dot(facets.normal(wall), ray.normal)) &&
           std::none_of(near.begin(), near.end(), [&](uint32_t side) {
             const bool opposed = glm::dot(facets.normal(side), facets.normal(wall)) < -TRACE_OWN_NORMAL;
             const double nearSide = opposed ? double{TRACE_ON_PLANE} : -double{TRACE_ON_PLANE};
             // A side that the wall stands on goes on behind it.
             const dvec3 centre = dvec3(unpackVoxel(facets.voxel[wall])) + 0.5;
             const double extent = voxelExtent(glm::vec3(facets.normal(side)));
             const bool footing =
                 !opposed && less(extent - TRACE_BEHIND, glm::dot(facets.normal(side), centre - facets.middle(side)));
             return !footing && less(-double{TRACE_ON_PLANE}, facets.distance(side, ray.origin)) &&
                    less(facets.distance(wall, facets.middle(side)), nearSide);
           });
  });
}

Hit traceRobust(const Facets& facets, const Ray& ray, const Passage& passage) {
  Hit hit{TRACE_ESCAPED};
  Walk walk(facets, ray, passage);
  uint32_t passed = TRACE_ESCAPED;
  double passedAt = 0;
  // Every comparison records its margin.
  const auto less = [&hit](double a, double b) {
    hit.margin = std::min(hit.margin, std::abs(a - b));
    return a < b;
  };
  if (ray.facet != NO_FACET && startsInside(facets, ray, less)) {
    hit.facet = TRACE_INVALID;
    return hit;
  }
  struct Met {
    double t = 1e30;
    uint32_t facet = TRACE_ESCAPED;
  };
  while (inside(facets, walk.cell) && hit.facet == TRACE_ESCAPED) {
    Met front, back;
    uint32_t around = 0;
    const std::vector<uint32_t> here = facetsAt(facets, walk.cell);
    // How far the extension of a neighbour's face reaches beyond the planes recorded here. It ends at these, since its
    // middle does not lie beyond them.
    const auto overrun = [&](uint32_t f, double t) {
      double beyond = 0;
      for (const uint32_t mine : here) {
        // A plane that the ray starts in front of, within what planes are known to, is taken through its origin.
        const double plane =
            startsBehind(facets, ray, mine, less) ? 0 : std::min(facets.distance(mine, ray.origin), 0.0);
        const double crossing = facets.distance(mine, ray.origin + t * ray.direction) - plane;
        beyond = std::max(beyond, less(facets.distance(mine, facets.middle(f)), plane) ? crossing : -crossing);
      }
      return beyond;
    };
    const auto own = [&](uint32_t f) {
      return less(TRACE_OWN_NORMAL, glm::dot(facets.normal(f), ray.normal)) &&
             less(std::abs(facets.distance(f, ray.origin)), TRACE_OWN_PLANE);
    };
    const auto rise = [&](uint32_t f) { return glm::dot(ray.normal, facets.middle(f) - ray.origin); };
    const auto ask = [&](uint32_t f, bool recorded) {
      const double start = facets.distance(f, ray.origin), slope = glm::dot(facets.normal(f), ray.direction);
      const double enter = start + slope * walk.enter, leave = start + slope * walk.leave, cross = -start / slope;
      const bool otherSide = less(glm::dot(facets.normal(f), ray.normal), -double{TRACE_OWN_NORMAL}) &&
                             less(std::min(rise(f), start), TRACE_ON_PLANE);
      if (less(slope, 0) && !startsBehind(facets, ray, f, less) && !otherSide) {
        const double slack = recorded ? TRACE_PLANE + facetJoint(facets.shape[f]) : TRACE_ON_PLANE;
        // Where a ray starts on both planes, a point a little ahead tells the side.
        const double at = std::min(std::max({cross, double{TRACE_PLANE}, walk.enter}), walk.leave);
        const double beyond = recorded ? 0 : overrun(f, at);
        if (!less(std::min(slack, double{TRACE_PLANE}), leave) && !less(enter, -slack) &&
            (recorded ? !cutOff(facets, f, ray.origin + at * ray.direction, less) : !less(TRACE_ON_PLANE, beyond))) {
          if (less(cross + beyond, front.t)) front = {cross + beyond, f};
        } else if (recorded && !less(TRACE_JOINT, leave) && less(0, enter)) {
          passed = f;
          passedAt = walk.leave;
        }
      } else if (!less(slope, 0) && recorded && !own(f) && less(enter, -double{TRACE_ON_PLANE}) &&
                 less(TRACE_ON_PLANE, leave) && less(cross, back.t) &&
                 !cutOff(facets, f, ray.origin + cross * ray.direction, less)) {
        back = {cross, f};
      }
    };
    for (const uint32_t f : here) {
      ask(f, /*recorded=*/true);
      if (facets.shape[f] & FACET_CORNER) around |= facets.around[f] & ~AROUND_SELF;
    }
    if (back.facet != TRACE_ESCAPED &&
        (front.facet == TRACE_ESCAPED ||
         less(TRACE_JOINT, facets.distance(back.facet, ray.origin + front.t * ray.direction)))) {
      front = back;
      if (!(facets.shape[back.facet] & FACET_DOUBLE_SIDED))
        front.facet = less(back.t, TRACE_NEAR) ? TRACE_INVALID : TRACE_BLOCKED;
    }
    if (front.facet == TRACE_ESCAPED)
      for (const uint32_t f : facetsAround(facets, walk.cell, around)) ask(f, /*recorded=*/false);
    if (front.facet != TRACE_ESCAPED) {
      hit.facet = front.facet;
      hit.t = std::max(front.t, 0.0);
    } else {
      walk.next();
    }
  }
  if (hit.facet > TRACE_LAST_FACET && passed != TRACE_ESCAPED) {
    const double end = hit.facet == TRACE_ESCAPED ? walk.enter : hit.t;
    if (less(end - passedAt, TRACE_NEAR)) {
      hit.facet = passed;
      hit.t = passedAt;
    }
  }
  hit.margin = std::min(hit.margin, walk.margin);
  return hit;
}

}  // namespace

dvec3 Facets::normal(uint32_t facet) const {
  return dvec3(decodeNormal(shape[facet] & 0xFFFFu, encoding));
}

dvec3 Facets::middle(uint32_t facet) const {
  return dvec3(unpackVoxel(voxel[facet])) + 0.5 + normal(facet) * double{facetOffset(shape[facet])};
}

double Facets::distance(uint32_t facet, const dvec3& p) const {
  return glm::dot(normal(facet), p - (dvec3(unpackVoxel(voxel[facet])) + 0.5)) - double{facetOffset(shape[facet])};
}

uint32_t Facets::Cuts::facet(uint32_t part, bool back) const {
  for (const uint32_t point : points)
    if (const uint32_t found = (point >> (back ? 8 : 0)) & 0xFFu; point >> 16 == part && found != PIECE_UNKNOWN)
      return found;
  return PIECE_UNKNOWN;
}

Facets::Cuts Facets::cutsOf(uint32_t piece) const {
  const std::span<const uint32_t> record = std::span(cuts).subspan(sides.at(piece) & ~PIECE_CUT);
  const size_t first = (record[0] & CUT_MASKED) != 0 ? 3 : 1, count = record[0] & ~CUT_MASKED;
  return {record.subspan(first, count), record.subspan(first + count, CUT_POINTS)};
}

bool Facets::maskLeaves(uint32_t piece, uint32_t bit) const {
  return (cuts.at((sides.at(piece) & ~PIECE_CUT) + 1 + bit / 32) >> (bit % 32) & 1) != 0;
}

dvec3 Facets::point(uint32_t surfel) const {
  const Surfel& s = surfels.at(surfel);
  const uint32_t triangle = s.triangle & ~SURFEL_BACK;
  const dvec3 a = corner(triangle, 0), normal = glm::cross(corner(triangle, 1) - a, corner(triangle, 2) - a);
  const glm::uvec3 cell = unpackVoxel(voxel.at(surfel / FACET_SURFELS));
  // Only the third coordinate is the plane's to say.
  dvec3 p = dvec3(cell) + dvec3(onPlane(glm::vec3(normal), glm::vec3(a - dvec3(cell)), unpackPlace(s.place)));
  const int axis = static_cast<int>(seenAlong(glm::vec3(normal)));
  p[axis] -= glm::dot(normal, p - a) / normal[axis];
  return p;
}

uint32_t raysOf(const Facets& facets, uint32_t facet, const MatrixParams& params) {
  return params.hitRule == HitRule::triangles ? facetRays(facets.area.at(facet), params.rays) : params.rays;
}

Ray facetRay(const Facets& facets, uint32_t facet, uint32_t k, const MatrixParams& params) {
  const glm::vec3 n = decodeNormal(facets.shape[facet] & 0xFFFFu, facets.encoding);
  const glm::uvec4 shifts = rayShifts(facets.voxel[facet], params.seed, params.jitter);
  if (params.hitRule == HitRule::triangles) {
    const float u = facetJitter(k, glm::uvec2(shifts.z, shifts.w)).x;
    const uint32_t surfel = FACET_SURFELS * facet + static_cast<uint32_t>(u * float{FACET_SURFELS});
    const Surfel& s = facets.surfels.at(surfel);
    const uint32_t triangle = s.triangle & ~SURFEL_BACK;
    const dvec3 a = facets.corner(triangle, 0);
    const dvec3 facing = glm::normalize(glm::cross(facets.corner(triangle, 1) - a, facets.corner(triangle, 2) - a)) *
                         ((s.triangle & SURFEL_BACK) != 0 ? -1.0 : 1.0);
    const dvec3 along(
        toWorld(cosineDirection(hammersley(k, raysOf(facets, facet, params), glm::uvec2(shifts))), glm::vec3(facing)));
    return {facets.point(surfel) + 1e-6 * facing, along, facing, facet, triangle};
  }
  const glm::vec3 direction = toWorld(cosineDirection(hammersley(k, params.rays, glm::uvec2(shifts))), n);
  const glm::uvec3 voxel = unpackVoxel(facets.voxel[facet]);
  const glm::vec3 origin =
      params.hitRule == HitRule::thesis
          ? glm::vec3(voxel) + 0.5f + n
          : facetPoint(voxel, n, facetOffset(facets.shape[facet]), facetJitter(k, glm::uvec2(shifts.z, shifts.w)));
  return {dvec3(origin), dvec3(direction), dvec3(n), facet, kNoTriangle};
}

Hit trace(const Facets& facets, const Ray& ray, HitRule hitRule, const Passage& passage) {
  switch (hitRule) {
    case HitRule::thesis:
      return traceThesis(facets, ray, passage);
    case HitRule::robust:
      return traceRobust(facets, ray, passage);
    case HitRule::triangles:
      return traceTriangles(facets, ray, passage);
  }
  return {};
}

std::optional<glm::uvec3> firstSolid(const Facets& facets, const Ray& ray) {
  // Enters the grid: a little beyond the point where the last of the axes enters it.
  double enter = 0, leave = std::numeric_limits<double>::infinity();
  for (int a = 0; a < 3; ++a) {
    if (ray.direction[a] == 0) continue;
    const double t0 = -ray.origin[a] / ray.direction[a], t1 = (facets.grid.dims[a] - ray.origin[a]) / ray.direction[a];
    enter = std::max(enter, std::min(t0, t1));
    leave = std::min(leave, std::max(t0, t1));
  }
  if (enter >= leave) return std::nullopt;
  Ray inner = ray;
  inner.origin += (enter > 0 ? enter + 1e-9 : 0.0) * ray.direction;
  for (Walk walk(facets, inner, {}); inside(facets, walk.cell); walk.next())
    if (!facetsAt(facets, walk.cell).empty()) return glm::uvec3(walk.cell);
  return std::nullopt;
}

void jacobi(const std::vector<Row>& rows, const std::vector<dvec3>& albedo, const std::vector<dvec3>& emission,
            const std::vector<dvec3>& direct, const SolverParams& params, uint32_t sweeps, Light& light) {
  std::vector<dvec3> next(rows.size());
  for (uint32_t s = 0; s < sweeps; ++s) {
    for (size_t i = 0; i < rows.size(); ++i) {
      dvec3 h(0);
      for (size_t e = 0; e < rows[i].columns.size(); ++e) h += rows[i].weights[e] * light.radiosity[rows[i].columns[e]];
      light.indirect[i] = h;
      const dvec3 b = double{params.lambda} * (emission[i] + albedo[i] * (direct[i] + h));
      next[i] = (1 - double{params.omega}) * light.radiosity[i] + double{params.omega} * b;
    }
    light.radiosity = next;
  }
}

}  // namespace irad::oracle
