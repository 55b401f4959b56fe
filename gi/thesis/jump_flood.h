// The distance field by jump flooding (docs/method.md 3, T 5.2; Rong and Tan 2006).
#pragma once

#include "gi/field.h"

namespace irad {

/// field.jfaDistance, jfaSeeds and jfaMax, recorded into a frame; `grid` holds the list's one Grid.
void recordJumpFloodField(Frame& frame, const char* stage, const FacetList& facets, const Buffer& grid, Field& field);
/// Passes of jump flooding: floor(log2(largest dimension)) + 1.
uint32_t jumpFloodPasses(const Grid& grid);
/// The nearest seed that each voxel knows after the first `passes` of them, packVoxel or NO_SEED; 0: solid voxels know
/// themselves.
Buffer recordJumpFlood(Frame& frame, const char* stage, const FacetList& facets, const Buffer& grid, uint32_t passes);

}  // namespace irad
