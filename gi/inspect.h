// The inspector: everything that is known of one voxel, its facets, and their rows of the form-factor matrix. For
// `irad export --inspect` and the window; tests compare it with the oracle.
#pragma once

#include <optional>
#include <vector>

#include "gi/facet_places.h"
#include "gi/field.h"
#include "gi/host_facets.h"
#include "gi/inspected.h"
#include "gi/oracle/rays.h"
#include "gi/pipeline.h"

namespace irad {

/// Holds the facets, the field, B, D and H of a pipeline in host memory (about 160 B a facet and 8 B a voxel, 12 with
/// jump flooding) from its first use on; rows and columns are read when asked for.
class Inspector {
 public:
  /// After a prepare() that succeeded; the pipeline outlives it.
  Inspector(Context& context, const Pipeline& pipeline);
  /// Reads again what prepare() has changed since.
  void refresh();

  const Grid& grid() const { return places_.facets.grid; }
  /// The whole record; the voxel is in the grid.
  InspectedVoxel voxel(const glm::uvec3& voxel) const;
  InspectedFacet facet(uint32_t facet) const;
  /// UsageError that names the grid and the nearest solid voxel where this one is outside or holds no facet.
  void requireFacets(const glm::uvec3& voxel) const;
  /// Which facets are seen where.
  const FacetPlaces& places() const { return places_; }
  glm::uvec3 voxelOf(uint32_t facet) const { return places_.facets.voxel.at(facet); }
  /// Ray k of a facet, step by step; k below the rays per facet.
  InspectedRay ray(uint32_t facet, uint32_t k) const;

 private:
  std::vector<uint32_t> traceOnDevice(uint32_t facet) const;
  std::optional<MeshNormal> meshNormal(uint32_t facet) const;
  const Field& field() const;
  Link link(uint32_t receiver, uint32_t sender, uint32_t hits, uint32_t hitsBack, bool row) const;
  void addLinks(uint32_t facet, InspectedFacet& record) const;
  RayPath path(const oracle::Ray& ray, const oracle::DistanceField* field, double& margin) const;

  Context& context_;
  const Pipeline& pipeline_;
  uint64_t build_ = 0;
  uint64_t materials_ = 0;  ///< likewise: Revision::materials
  FacetPlaces places_;
  std::optional<Field> madeField_;  ///< where the pipeline has none
  oracle::DistanceField field_;
  std::vector<uint32_t> seeds_;   ///< packVoxel, with jump flooding
  std::vector<glm::uvec2> rows_;  ///< MatrixArrays::rowInfo
  std::vector<glm::vec3> direct_, irradiance_, radiosity_, correction_, sky_, reflected_, standardError_;
};

/// Of these facets, from the dark.
SolveHistory replaySolve(Context& context, const Pipeline& pipeline, const std::vector<uint32_t>& facets,
                         const Progress& progress = {});

}  // namespace irad
