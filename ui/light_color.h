// The hue and saturation of a light for the eye, at full brightness.
#pragma once

#include <algorithm>
#include <glm/gtc/color_space.hpp>

#include "ui/imgui.h"

namespace irad {

/// The hue of a linear colour, sRGB-encoded as the window image is.
inline ImU32 displayColor(const glm::vec3& linear) {
  const glm::vec3 c = glm::convertLinearToSRGB(linear / std::max({linear.x, linear.y, linear.z, 1e-6f}));
  return ImGui::ColorConvertFloat4ToU32({c.x, c.y, c.z, 1});
}

/// A colour field and the button of its picker, shown as on a display. True where it was edited: linear, 0 to 1.
/// Components that are not edited keep their bits: there and back again they would drift, in every frame in which a
/// number is being typed.
bool colorField(const char* id, glm::vec3& linear);

}  // namespace irad
