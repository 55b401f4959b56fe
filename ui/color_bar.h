// A colour map as a bar.
#pragma once

#include <imgui.h>

#include <glm/glm.hpp>

namespace irad {

/// A colour of a map, COLOR_MAP_*, at t in 0..1, for draw lists.
ImU32 mapColor(uint32_t map, float t, float alpha = 1);
/// The whole map from left to right; pixels.
void drawColorBar(ImDrawList& list, glm::vec2 at, glm::vec2 size, uint32_t map);

}  // namespace irad
