// The distance field by jump flooding (docs/method.md 3, T 5.2; Rong and Tan 2006).
#pragma once

#include <cstdint>

#include "renderer/resources.h"

namespace irad {

class Frame;
struct FacetList;
struct Grid;

struct JumpFloodField {
  Image distance;     ///< R8_UNORM volume: Euclidean distance / largest
  float largest = 0;  ///< voxels that 1.0 stands for
  Image seeds;        ///< R32_UINT packVoxel of the nearest seed, the last pass
  explicit operator bool() const { return static_cast<bool>(distance); }
};
/// Recorded into a frame; `grid` holds the list's one Grid.
JumpFloodField recordJumpFloodField(Frame& frame, const char* stage, const FacetList& facets, const Buffer& grid);
/// Passes of jump flooding: floor(log2(largest dimension)) + 1.
uint32_t jumpFloodPasses(const Grid& grid);
/// The nearest seed that each voxel knows after the first `passes` of them, packVoxel or NO_SEED; 0: solid voxels know
/// themselves.
Buffer recordJumpFlood(Frame& frame, const char* stage, const FacetList& facets, const Buffer& grid, uint32_t passes);

}  // namespace irad
