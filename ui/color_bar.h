// A colour map as a bar.
#pragma once

#include <glm/glm.hpp>

#include "shaders/shared/color_map.h"
#include "ui/imgui.h"

namespace irad {

/// A colour of a map at t in 0..1, for draw lists.
ImU32 mapColor(ColorMap map, float t, float alpha = 1);
/// The whole map from left to right; pixels.
void drawColorBar(ImDrawList& list, glm::vec2 at, glm::vec2 size, ColorMap map);

}  // namespace irad
