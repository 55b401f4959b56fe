// What voxelization must give, in double precision: plain loops over all cells of a triangle's bounds.
#pragma once

#include <array>
#include <glm/glm.hpp>
#include <vector>

#include "shaders/shared/grid.h"

namespace irad::oracle {

/// A triangle in voxel units, from the fp32 coordinates that the shaders compute: (p - origin) x inverseEdge.
using Triangle = std::array<glm::dvec3, 3>;
Triangle toVoxels(const Grid& grid, const glm::vec3& a, const glm::vec3& b, const glm::vec3& c);

enum class Cover : uint8_t { No, Unsure, Yes };

/// Whether the triangle has a point in the half-open cell, by the separating axes of triangle and box (Akenine-Moller
/// 2001, "Fast 3D Triangle-Box Overlap Testing"). The three box axes are decided exactly: they are the half-open rule.
/// On the ten others, a gap or an overlap of less than `band` voxels is Unsure: fp32 cannot tell.
Cover cover(const Triangle& triangle, glm::ivec3 cell, double band);

/// Area of the part of the triangle inside the closed cell, in voxel faces.
double areaInside(const Triangle& triangle, glm::ivec3 cell);
/// The middle of that part; of the whole triangle where there is none.
glm::dvec3 middleInside(const Triangle& triangle, glm::ivec3 cell);
/// Where the triangle's plane crosses the cell's middle line along the axis that it faces most.
glm::dvec3 onMiddleLine(const Triangle& triangle, glm::ivec3 cell);

/// The band for a grid: fp32 voxel coordinates are off by an ulp of the largest, products of differences by a few.
double coverBand(const Grid& grid);

struct Coverage {
  std::vector<Cover> cover;  ///< per voxel: Yes if some triangle is sure to cover it, No if none can
  std::vector<double> area;  ///< per voxel: the largest area of one triangle inside
  /// Per voxel: how far in front of its centre, along its facing, the frontmost triangle lies that crosses the voxel's
  /// middle line along the triangle's dominant axis; -1 where none does. `sure`: beyond the doubt of fp32; `possible`:
  /// doubtful ones too.
  std::vector<double> sureFront, possibleFront;
};
Coverage voxelize(const Grid& grid, const std::vector<glm::vec3>& positions, const std::vector<uint32_t>& indices);

/// Voxels that can be reached from `start` through faces of voxels that are not solid.
std::vector<bool> floodFill(const Grid& grid, const std::vector<bool>& solid, glm::uvec3 start);

}  // namespace irad::oracle
