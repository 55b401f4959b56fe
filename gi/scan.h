// Prefix sums on the device.
#pragma once

#include "renderer/frame/frame.h"

namespace irad {

/// Exclusive scan of `count` uints in place; the total is written to `total` (one uint at element 0). Deterministic.
void exclusiveScan(Frame& frame, const char* stage, const Buffer& values, uint32_t count, const Buffer& total);

}  // namespace irad
