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
    const std::vector<uint32_t> here = facetsAt(facets, walk.cell);
    if (here.empty()) continue;
    const double slope = glm::dot(facets.normal(here.front()), ray.direction);
    hit.margin = std::min(hit.margin, std::abs(slope));
    if (slope < 0) {
      hit.facet = here.front();
      hit.t = walk.enter;
      break;
    }
  }
  hit.margin = std::min(hit.margin, walk.margin);
  return hit;
}

}  // namespace

dvec3 Facets::normal(uint32_t facet) const {
  return dvec3(decodeNormal(shape[facet] & 0xFFFFu, encoding));
}

uint32_t Facets::Cuts::facet(uint32_t part, bool back) const {
  for (const uint32_t known : parts)
    if (known >> 16 == part) return (known >> (back ? 8 : 0)) & 0xFFu;
  return PIECE_UNKNOWN;
}

Facets::Cuts Facets::cutsOf(uint32_t piece) const {
  const std::span<const uint32_t> record = std::span(cuts).subspan(sides.at(piece) & ~PIECE_CUT);
  const size_t first = cutHead(record[0]), count = cutTriangles(record[0]);
  return {record.subspan(first, count), record.subspan(first + count, cutParts(record[0]))};
}

bool Facets::maskLeaves(uint32_t piece, uint32_t bit) const {
  return (cuts.at((sides.at(piece) & ~PIECE_CUT) + 1 + bit / 32) >> (bit % 32) & 1) != 0;
}

uint32_t Facets::closedChannels(uint32_t piece, uint32_t bit) const {
  const size_t place = (sides.at(piece) & ~PIECE_CUT) + 3 + bit / 32;
  uint32_t closed = 0;
  for (uint32_t c = 0; c < 3; ++c) closed |= (cuts.at(place + 2 * c) >> (bit % 32) & 1) << c;
  return closed;
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
  const glm::vec3 origin = glm::vec3(unpackVoxel(facets.voxel[facet])) + 0.5f + n;
  return {dvec3(origin), dvec3(direction), dvec3(n), facet, kNoTriangle};
}

Hit trace(const Facets& facets, const Ray& ray, HitRule hitRule, const Passage& passage) {
  switch (hitRule) {
    case HitRule::thesis:
      return traceThesis(facets, ray, passage);
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
