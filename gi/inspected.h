// What the inspector knows of a voxel, its facets and their rows of the form-factor matrix, as plain numbers.
#pragma once

#include <cstdint>
#include <glm/glm.hpp>
#include <optional>
#include <string>
#include <vector>

#include "shaders/shared/grid.h"
#include "shaders/shared/normals.h"

namespace irad {

/// What one facet, the receiver, gets from another, the sender.
struct Link {
  uint32_t facet = 0;          ///< at the far end: the sender in a row, the receiver in a column
  glm::uvec3 voxel{0};         ///< its voxel
  glm::dvec3 position{0};      ///< of its plane next to the voxel's centre, world
  uint32_t hits = 0;           ///< of the receiver's rays on the sender
  double formFactor = 0;       ///< F: share of the receiver's valid rays
  double distance = 0;         ///< between the two facets' planes at their voxels' middles, m
  glm::dvec3 radiosity{0};     ///< B of the sender, W/m^2
  glm::dvec3 contribution{0};  ///< F B, a part of the receiver's H, W/m^2
  double exchange = 0;         ///< A F of the receiver, m^2
  double opposite = 0;         ///< A F of the sender upon the receiver, m^2: by reciprocity the same but for the noise
};
/// A row (what a facet gathers from) or a column (who gathers from it).
struct Links {
  std::vector<Link> links;     ///< by luminance of the contribution, strongest first
  double sum = 0;              ///< of form factors
  glm::dvec3 contribution{0};  ///< of contributions, W/m^2; of a row: H but for `correction`, `sky`, the residual
  double exchange = 0, opposite = 0;  ///< sums, m^2
};

/// What the rays of a row met. Blocked: by a back face; invalid: does not count, having started behind a surface.
struct RayShares {
  uint32_t rays = 0, hits = 0, escaped = 0, blocked = 0, invalid = 0;
};

/// The mesh under a facet: the triangle that won its voxel or, of those that it stands for, the one in its middle.
struct MeshNormal {
  uint32_t triangle = 0;
  bool back = false;  ///< the facet is the triangle's back side
  /// Unit, on the facet's side: the triangle's plane, and the vertex normals interpolated where the facet was sampled.
  glm::dvec3 face{0}, shading{0};
  double faceError = 0, shadingError = 0;  ///< angle from each to the decoded normal, degrees
};

struct InspectedFacet {
  uint32_t facet = 0;
  glm::uvec3 voxel{0};
  uint32_t shape = 0;              ///< the stored word: normal code, plane offset, flags (shared/facets.h)
  glm::dvec3 position{0};          ///< of its plane next to the voxel's centre, world
  glm::dvec3 normal{0};            ///< decoded
  std::optional<MeshNormal> mesh;  ///< none of lists without triangles
  double area = 0;                 ///< m^2
  glm::dvec3 albedo{0};
  glm::dvec3 emission{0}, direct{0}, irradiance{0}, radiosity{0};  ///< M, D, H, B, W/m^2
  glm::dvec3 correction{0};     ///< what samples of the emitters add to H in place of rays, W/m^2
  glm::dvec3 sky{0};            ///< the part of H that comes straight from the sky, W/m^2
  glm::dvec3 reflected{0};      ///< W, reflections that are written back, W/m^2
  glm::dvec3 standardError{0};  ///< of H by brute force, W/m^2; 0 with a matrix
  double residual = 0;          ///< how far one more sweep would move B, largest channel, W/m^2
  RayShares rays;
  std::vector<uint32_t> met;  ///< by ray: a facet or TRACE_*, traced again on the device
  Links row, column;
};

struct InspectedVoxel {
  glm::uvec3 voxel{0};
  glm::dvec3 world{0};             ///< of its centre
  double distance = 0;             ///< to the nearest solid voxel by the field in use, voxels
  std::optional<glm::uvec3> seed;  ///< nearest solid voxel by jump flooding; with field.method jfa
  std::vector<InspectedFacet> facets;
};

/// One cell that a ray went through.
struct RayStep {
  glm::ivec3 cell{0};
  double t = 0;        ///< at which it was entered, voxels
  double length = 0;   ///< from there to the next one, or to the end
  uint32_t faces = 0;  ///< facets in it; 0: empty, or outside of the grid
};
struct RayPath {
  std::vector<RayStep> steps;
  uint32_t met = 0;  ///< a facet or TRACE_*
  double t = 0;      ///< where, voxels
};
struct InspectedRay {
  uint32_t facet = 0, ray = 0;
  glm::dvec3 origin{0}, direction{0};  ///< voxel units
  RayPath dda, sdf;                    ///< by the oracle, in double precision: cell by cell, and by the field in use
  uint32_t device = 0;                 ///< what the build's kernel meets
  double margin = 0;  ///< closest decision on the way, voxels or cosine: fp32 may differ below about 1e-3
};

/// Both rows' entries for every sender that either has.
struct RowComparison {
  struct Entry {
    uint32_t facet;
    glm::uvec3 voxel;
    double a, b;  ///< F
  };
  std::vector<Entry> entries;  ///< by |a - b|, largest first
  double difference = 0;       ///< sum of |a - b|
  double shared = 0;           ///< sum of min(a, b)
};
RowComparison compareRows(const Links& a, const Links& b);

/// A cell of a slice (settings.view), and the facet of it that faces the start of a ray more, if it holds any.
struct SliceCell {
  glm::uvec3 voxel;
  std::optional<uint32_t> facet;
};

/// "facet 123", "left the grid", "the back of a face", "invalid: began behind a surface".
std::string describeMet(uint32_t met);
/// Whether the three traces of a ray agree, and where not.
std::string describe(const InspectedRay& ray);

/// H of some facets after every sweep of a solve from the dark, beside the pipeline's own light.
struct SolveHistory {
  std::vector<std::vector<glm::vec3>> irradiance;  ///< [sweep][facet], W/m^2
  std::vector<float> residual;                     ///< [sweep] of the whole scene, W/m^2
  bool converged = false;
};

/// A record as JSON (units as above); `history` of the voxel's facets, in order.
std::string inspectJson(const InspectedVoxel& record, const Grid& grid, NormalEncoding encoding,
                        const SolveHistory& history);

}  // namespace irad
