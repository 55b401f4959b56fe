// What both methods of voxelization record (gi/voxelize.cpp, gi/thesis/raster_voxels.cpp).
#pragma once

#include <vector>

#include "renderer/resources.h"
#include "shaders/shared/voxelize.h"

namespace irad {

class Context;
class Pass;
class SceneOnDevice;
struct Voxels;

inline constexpr const char* kVoxelizeStage = "GI Voxelization";

/// Triangles that one dispatch or draw takes: those of a masked material alone, with its textures; all between two such
/// together.
struct TriangleRange {
  uint32_t first, end;  ///< triangles
  uint32_t material;    ///< whose set is bound
  bool masked;          ///< its alpha decides
};
/// InputError where the scene has more triangles than voxelization takes.
std::vector<TriangleRange> triangleRanges(const SceneOnDevice& scene);

/// The pieces of triangles that workgroups take.
struct Tiles {
  Buffer starts;                 ///< of each triangle
  std::vector<uint32_t> bounds;  ///< of each range: where its tiles start; and the end
};
/// Counts the tiles of every triangle and reads back where each range's tiles start. `grid`: one Grid.
Tiles countTiles(Context& context, const SceneOnDevice& scene, const Buffer& grid,
                 const std::vector<TriangleRange>& ranges);

/// The part of the push constants that all ranges have in a pass, and what the pass reads and writes.
VoxelizePush voxelizePush(Pass& pass, const Voxels& voxels, bool masked);

}  // namespace irad
