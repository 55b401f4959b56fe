#include "gi/facet_places.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include "gi/facets.h"
#include "gi/oracle/voxels.h"
#include "gi/pipeline.h"
#include "gi/settings.h"
#include "renderer/frame/transfer.h"
#include "renderer/scene/scene.h"
#include "shaders/shared/slice.h"

namespace irad {

FacetPlaces::FacetPlaces(Context& context, const Pipeline& pipeline)
    : facets(hostFacets(context, pipeline.facets())),
      list(oracleFacets(context, pipeline.facets())),
      origin_(pipeline.scene().origin) {
  if (const Buffer& triangle = pipeline.facets().triangle) triangles = downloadAs<uint32_t>(context, triangle);
  for (size_t k = FACET_SURFELS / 2; k < list.surfels.size(); k += FACET_SURFELS)
    triangles.push_back(list.surfels[k].triangle);
}

bool FacetPlaces::contains(const glm::ivec3& voxel) const {
  return glm::all(glm::greaterThanEqual(voxel, glm::ivec3(0))) &&
         glm::all(glm::lessThan(voxel, glm::ivec3(facets.grid.dims)));
}

std::vector<uint32_t> FacetPlaces::facetsOf(const glm::uvec3& voxel) const {
  if (facets.count() == 0) return {};
  const uint32_t entry = list.reverse.at(voxelIndex(voxel, facets.grid.dims));
  if (entry == NO_FACET) return {};
  std::vector<uint32_t> in(::irad::facetsOf(entry));
  std::iota(in.begin(), in.end(), firstFacet(entry));
  return in;
}

glm::dvec3 FacetPlaces::toVoxels(const glm::dvec3& world) const {
  return (world - origin_ - glm::dvec3(facets.grid.origin)) / double{facets.grid.edge};
}

std::optional<uint32_t> FacetPlaces::facetAt(const glm::dvec3& point, const glm::dvec3& normal) const {
  const glm::dvec3 p = toVoxels(point);
  std::optional<uint32_t> best;
  double nearest = std::numeric_limits<double>::infinity();
  for (int around = 0; around < 27; ++around) {
    const glm::ivec3 cell = glm::ivec3(glm::floor(p)) + glm::ivec3(around % 3, around / 3 % 3, around / 9) - 1;
    if (!contains(cell)) continue;
    for (const uint32_t f : facetsOf(glm::uvec3(cell))) {
      const glm::dvec3 middle = (facets.position[f] - glm::dvec3(facets.grid.origin)) / double{facets.grid.edge};
      const double away = glm::distance(p, middle);
      if (glm::dot(facets.normal[f], normal) <= 0 || away >= nearest) continue;
      nearest = away;
      best = f;
    }
  }
  return best;
}

/// Of the facets in a voxel, the one that faces the eye more; voxel units.
std::optional<uint32_t> FacetPlaces::facing(const glm::uvec3& voxel, const glm::dvec3& eye) const {
  const std::vector<uint32_t> all = facetsOf(voxel);
  if (all.empty()) return std::nullopt;
  const glm::dvec3 towards = eye - (glm::dvec3(voxel) + 0.5);
  return *std::max_element(all.begin(), all.end(), [&](uint32_t a, uint32_t b) {
    return glm::dot(facets.normal[a], towards) < glm::dot(facets.normal[b], towards);
  });
}

std::optional<SliceCell> FacetPlaces::inSlice(const glm::dvec3& start, const glm::dvec3& direction,
                                              const glm::dvec3& forward, const ViewSettings& view) const {
  const glm::dvec3 origin = toVoxels(start);
  const auto axis = static_cast<int>(sliceAxis(view.axis, glm::vec3(forward)));
  const double layer = sliceLayer(static_cast<float>(facets.grid.dims[axis]), view.slice);
  const double t = (layer + 0.5 - origin[axis]) / direction[axis];
  if (!(t > 0) || !std::isfinite(t)) return std::nullopt;
  glm::dvec3 cell = glm::floor(origin + t * direction);
  cell[axis] = layer;
  if (!contains(glm::ivec3(cell))) return std::nullopt;
  return SliceCell{glm::uvec3(cell), facing(glm::uvec3(cell), origin)};
}

std::optional<uint32_t> FacetPlaces::facetAlong(const glm::dvec3& start, const glm::dvec3& direction) const {
  oracle::Ray ray;
  ray.origin = toVoxels(start);
  ray.direction = direction;
  const std::optional<glm::uvec3> voxel = oracle::firstSolid(list, ray);
  if (!voxel) return std::nullopt;
  return facing(*voxel, ray.origin);
}

}  // namespace irad
