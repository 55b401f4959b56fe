// What both methods of voxelization record (gi/voxelize.cpp, gi/thesis/raster_voxels.cpp).
#pragma once

#include <vector>

#include "shaders/shared/voxelize.h"

namespace irad {

class Pass;
class SceneOnDevice;
struct Settings;
struct Voxels;

inline constexpr const char* kVoxelizeStage = "GI Voxelization";

/// Triangles that one dispatch or draw takes: those of a masked material alone, with its textures; all between two such
/// together.
struct TriangleRange {
  uint32_t first, end;  ///< triangles
  uint32_t material;    ///< whose set is bound
  bool masked;          ///< its alpha decides
};
std::vector<TriangleRange> triangleRanges(const SceneOnDevice& scene);

/// The part of the push constants that all ranges have in a pass over a facet slot, and what the pass reads and writes.
VoxelizePush voxelizePush(Pass& pass, const Voxels& voxels, const Settings& settings, uint32_t slot, bool masked);

}  // namespace irad
