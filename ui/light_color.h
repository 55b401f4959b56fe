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

/// A colour field, shown as on a display. True where it was edited: linear, 0 to 1. Components that are not edited keep
/// their bits: there and back again they would drift, in every frame in which a number is being typed.
inline bool colorField(const char* id, glm::vec3& linear) {
  const glm::vec3 before = glm::convertLinearToSRGB(linear);
  glm::vec3 shown = before;
  if (!ImGui::ColorEdit3(id, &shown.x, ImGuiColorEditFlags_Float)) return false;
  const glm::vec3 edited = glm::clamp(glm::convertSRGBToLinear(shown), 0.0f, 1.0f);
  for (int c = 0; c < 3; ++c)
    if (shown[c] != before[c]) linear[c] = edited[c];
  return true;
}

}  // namespace irad
