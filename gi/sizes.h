// Smaller sizes, for where the defaults do not fit into memory (docs/method.md).
#pragma once

#include "gi/settings.h"

namespace irad {

/// The next smaller sizes: fewer rays first (to 128), then fewer voxels (to N = 64). False when they are that small
/// already.
bool lowerSizes(Settings& settings);

}  // namespace irad
