// Rays through the facets cell by cell in double precision, and the relight by plain loops.
#pragma once

#include <glm/glm.hpp>
#include <vector>

#include "shaders/shared/facets.h"
#include "shaders/shared/gi_params.h"
#include "shaders/shared/grid.h"

namespace irad::oracle {

/// A facet list on the host.
struct Facets {
  Grid grid;
  uint32_t encoding = 3;
  std::vector<uint32_t> voxel, shape, reverse, around;
  glm::dvec3 normal(uint32_t facet) const;
  /// The point of the plane nearest to the voxel's centre, voxel units.
  glm::dvec3 middle(uint32_t facet) const;
  /// Signed distance of `p` (voxel units) from the facet's plane.
  double distance(uint32_t facet, const glm::dvec3& p) const;
};

struct Ray {
  glm::dvec3 origin, direction;  ///< voxel units
  glm::dvec3 normal;             ///< of the surface it leaves
  uint32_t facet = NO_FACET;     ///< that it leaves, if it starts on one
};
/// Ray k of a facet, from the shared sampling functions.
Ray facetRay(const Facets& facets, uint32_t facet, uint32_t k, const MatrixParams& params);

struct Hit {
  uint32_t facet = 0;  ///< or TRACE_*
  double t = 0;
  /// Least distance (voxels) or cosine by which a decision on the way was taken: below about 1e-3 fp32 may differ.
  double margin = 1e9;
};
Hit trace(const Facets& facets, const Ray& ray, uint32_t hitRule);

/// One row per facet: columns, and weights F_ij.
struct Row {
  std::vector<uint32_t> columns;
  std::vector<double> weights;
};
struct Light {
  std::vector<glm::dvec3> radiosity, indirect;
};
/// `sweeps` of H <- F B, B <- (1 - omega) B + omega lambda (M + rho (D + H)).
void jacobi(const std::vector<Row>& rows, const std::vector<glm::dvec3>& albedo,
            const std::vector<glm::dvec3>& emission, const std::vector<glm::dvec3>& direct, const SolverParams& params,
            uint32_t sweeps, Light& light);

}  // namespace irad::oracle
