// Which facet is where, in host memory: for what a picture is pointed at.
#pragma once

#include <optional>
#include <vector>

#include "gi/host_facets.h"
#include "gi/inspected.h"
#include "gi/oracle/rays.h"

namespace irad {

class Context;
class Pipeline;
struct ViewSettings;

/// The facets of a build of a pipeline, read from the device at once; about 100 B a facet and 4 B a voxel.
class FacetPlaces {
 public:
  FacetPlaces() = default;
  FacetPlaces(Context& context, const Pipeline& pipeline);
  HostFacets facets;
  oracle::Facets list;
  std::vector<uint32_t> triangles;  ///< per facet one that it stands for, | SURFEL_BACK; or none

  bool contains(const glm::ivec3& voxel) const;
  std::vector<uint32_t> facetsOf(const glm::uvec3& voxel) const;
  /// The facet that a point of a surface lies on, by its side: of those in its voxel and around it that face the same
  /// way, the one whose middle is nearest. World point, unit normal.
  std::optional<uint32_t> facetAt(const glm::dvec3& point, const glm::dvec3& normal) const;
  /// The facet that a ray meets where voxels are drawn as cubes: of the first voxel that holds any, the one that faces
  /// the ray's start more. World point, unit direction.
  std::optional<uint32_t> facetAlong(const glm::dvec3& start, const glm::dvec3& direction) const;
  /// The cell of a slice (settings.view) that a ray meets in front of its start. `forward`: where the camera looks.
  std::optional<SliceCell> inSlice(const glm::dvec3& start, const glm::dvec3& direction, const glm::dvec3& forward,
                                   const ViewSettings& view) const;
  /// From a point of the world to the grid's own coordinates, voxels.
  glm::dvec3 toVoxels(const glm::dvec3& world) const;

 private:
  std::optional<uint32_t> facing(const glm::uvec3& voxel, const glm::dvec3& eye) const;
  glm::dvec3 origin_{0};  ///< the scene's, world
};

}  // namespace irad
