// Rays through the facets cell by cell in double precision, and the relight by plain loops.
#pragma once

#include <glm/glm.hpp>
#include <optional>
#include <span>
#include <vector>

#include "shaders/shared/facets.h"
#include "shaders/shared/gi_params.h"
#include "shaders/shared/grid.h"
#include "shaders/shared/normals.h"
#include "shaders/shared/surface.h"

namespace irad::oracle {

/// A facet list on the host.
struct Facets {
  Grid grid;
  NormalEncoding encoding = NormalEncoding::oct16;
  std::vector<uint32_t> voxel, shape, reverse;
  // Of lists by classes of surfels (gi/surface.h); else empty.
  std::vector<glm::vec4> corners;
  std::vector<uint32_t> firstPiece, pieces, sides, cuts;
  std::vector<Surfel> surfels;
  std::vector<float> area;  ///< voxel faces
  glm::dvec3 corner(uint32_t triangle, uint32_t i) const { return glm::dvec3(corners.at(3 * triangle + i)); }
  bool hasHoles(uint32_t triangle) const { return corners.at(3 * triangle + 1).w > 0; }  ///< cut by a mask
  bool showsBack(uint32_t triangle) const { return corners.at(3 * triangle).w > 0; }
  bool repeats(uint32_t triangle) const { return corners.at(3 * triangle + 2).w > 0; }  ///< another: has no pieces
  /// What stands on a cut piece, and its parts (SurfaceArrays::cuts).
  struct Cuts {
    std::span<const uint32_t> triangles, parts;
    /// The facet of the side of a part, counted from the voxel's first, or PIECE_*.
    uint32_t facet(uint32_t part, bool back) const;
  };
  Cuts cutsOf(uint32_t piece) const;
  /// Whether a piece's mask leaves the square of a bit (maskBit).
  bool maskLeaves(uint32_t piece, uint32_t bit) const;
  /// The channels that it is closed to, of a pane that tints.
  uint32_t closedChannels(uint32_t piece, uint32_t bit) const;
  bool isTinted(uint32_t triangle) const { return corners.at(3 * triangle + 1).w > 1; }
  glm::dvec3 point(uint32_t surfel) const;  ///< voxel units
  glm::dvec3 normal(uint32_t facet) const;
};

inline constexpr uint32_t kNoTriangle = 0xFFFFFFFFu;
struct Ray {
  glm::dvec3 origin, direction;  ///< voxel units
  glm::dvec3 normal;             ///< of the surface it leaves
  uint32_t facet = NO_FACET;     ///< that it leaves, if it starts on one
  uint32_t triangle = kNoTriangle;
};
/// How many rays a facet has.
uint32_t raysOf(const Facets& facets, uint32_t facet, const MatrixParams& params);
/// Ray k of a facet, from the shared sampling functions; k is less than raysOf.
Ray facetRay(const Facets& facets, uint32_t facet, uint32_t k, const MatrixParams& params);

struct Hit {
  uint32_t facet = 0;  ///< or TRACE_*
  double t = 0;
  /// Least distance (voxels) or cosine by which a decision on the way was taken: below about 1e-3 fp32 may differ.
  double margin = 1e9;
};

/// Distance of every voxel to the nearest solid one, voxels; 0 in solid ones.
struct DistanceField {
  bool euclidean = false;  ///< T 5.2's, sphere-marched; else Chebyshev's, whose empty cubes are stepped over
  std::vector<float> voxels;
};
/// How a ray gets through empty cells, and the trace that it leaves.
struct Passage {
  const DistanceField* field = nullptr;  ///< null: cell by cell
  struct Step {
    glm::ivec3 cell;
    double t;  ///< at which it was entered, voxels
  };
  std::vector<Step>* steps = nullptr;  ///< if wanted: every cell entered, in order; the last may be outside of the grid
};
Hit trace(const Facets& facets, const Ray& ray, HitRule hitRule, const Passage& passage = {});

/// The first of all triangles that a ray meets, without voxels, sides or masks.
struct First {
  uint32_t triangle = kNoTriangle;
  double t = 0, edge = 0;  ///< voxels; how close to an edge: its least weight of a corner, without sign
};
First firstOfAll(const Facets& facets, const Ray& ray);

/// The first voxel with a facet along a ray from anywhere.
std::optional<glm::uvec3> firstSolid(const Facets& facets, const Ray& ray);

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
