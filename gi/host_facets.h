// The facet list and the distance field in host memory: for exports, checks, the inspector and the oracle.
#pragma once

#include <vector>

#include "shaders/shared/grid.h"

namespace irad {

namespace oracle {
struct Facets;
}
class Buffer;
class Context;
struct FacetList;
struct Field;

struct HostFacets {
  Grid grid;
  std::vector<glm::uvec3> voxel;
  /// The point of the facet's plane nearest to its voxel's centre, or the middle of its surfels; local.
  std::vector<glm::dvec3> position;
  std::vector<glm::dvec3> surfels;          ///< local, FACET_SURFELS per facet; none where facets are planes
  std::vector<glm::dvec3> normal;           ///< as stored
  std::vector<glm::vec3> albedo, emission;  ///< rho; M, W/m^2
  std::vector<double> area;                 ///< of the plane inside the voxel, m^2
  size_t count() const { return voxel.size(); }
};
HostFacets hostFacets(Context& context, const FacetList& list);
/// The same list as the oracle's rays take it.
oracle::Facets oracleFacets(Context& context, const FacetList& list);

/// One value per facet of a buffer of vec4; 0 where there is none (Lighting of no light).
std::vector<glm::vec3> perFacet(Context& context, const FacetList& list, const Buffer& values);

/// Distance from every voxel to the nearest solid one, in the metric of field.method, voxels.
std::vector<float> hostDistances(Context& context, const Grid& grid, const Field& field);

}  // namespace irad
