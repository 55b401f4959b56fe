// Compaction works by blocks of 4 x 4 x 4 voxels: 64 consecutive Morton codes (every axis has at least two bits).
#include "shared/voxelize.h"

/// Voxel `code` (0..63) of a block, relative to its first.
uvec3 inBlock(uint code) {
  return uvec3((code & 1u) | ((code >> 2) & 2u), ((code >> 1) & 1u) | ((code >> 3) & 2u),
               ((code >> 2) & 1u) | ((code >> 4) & 2u));
}
