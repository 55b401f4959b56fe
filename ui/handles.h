// What handles in the picture share (ui/overlays/): colours of the axes, lines that are seen on any ground, and what a
// drag along an axis means.
#pragma once

#include <array>
#include <cstddef>
#include <optional>

#include "ui/imgui.h"
#include "ui/viewport.h"

namespace irad {

constexpr ImU32 kHandleEdge = IM_COL32(0, 0, 0, 200);
constexpr std::array kAxisNames{"x", "y", "z"};
constexpr std::array kAxisColors{IM_COL32(240, 90, 90, 255), IM_COL32(120, 210, 90, 255), IM_COL32(100, 150, 255, 255)};

inline ImVec2 toImVec(glm::vec2 v) {
  return {v.x, v.y};
}

/// Of a round handle, pixels.
float handleRadius();

/// Seen on any ground.
void drawHandleLine(ImDrawList& list, glm::vec2 from, glm::vec2 to, ImU32 color);

glm::dvec3 axisVector(int axis);

/// `from`, moved along an axis by as much as what is nearest to the mouse on it moves while the mouse goes from one
/// place of the screen to another; none where the axis points at the eye.
std::optional<glm::dvec3> movedAlongAxis(const Picture& picture, const glm::dvec3& from, int axis, glm::vec2 mouseFrom,
                                         glm::vec2 mouseTo);

}  // namespace irad
