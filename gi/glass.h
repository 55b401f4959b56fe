// Blended surfaces in pictures (docs/method.md 7): the picture of the nearest surfaces, then of those behind them, and
// at last of what is opaque, each covering what comes after it by its alpha, or tinting it.
#pragma once

#include <functional>

#include "renderer/targets.h"

namespace irad {

/// `draw` composes the view of one layer of surfaces into targets.linear, which holds the whole picture in the end.
/// `layers`: blended surfaces behind each other that are shown, at least 1; `tinted`: some of them tint what is behind.
void drawLayers(Frame& frame, uint32_t layers, bool tinted, const std::function<void(Layer)>& draw, Targets& targets);

}  // namespace irad
