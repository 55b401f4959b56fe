// Linear colours of lights for the eye: sRGB-encoded, as the window image is (IEC 61966-2-1).
#pragma once

#include <imgui.h>

#include <algorithm>
#include <cmath>
#include <glm/glm.hpp>

namespace irad {

inline float encoded(float linear) {
  const float v = std::clamp(linear, 0.0f, 1.0f);
  return v <= 0.0031308f ? 12.92f * v : 1.055f * std::pow(v, 1 / 2.4f) - 0.055f;
}
inline float decoded(float shown) {
  return shown <= 0.04045f ? shown / 12.92f : std::pow((shown + 0.055f) / 1.055f, 2.4f);
}
inline glm::vec3 encoded(const glm::vec3& linear) {
  return {encoded(linear.x), encoded(linear.y), encoded(linear.z)};
}
inline glm::vec3 decoded(const glm::vec3& shown) {
  return {decoded(shown.x), decoded(shown.y), decoded(shown.z)};
}
/// Of full brightness: a colour's hue and saturation.
inline ImU32 displayColor(const glm::vec3& linear) {
  const glm::vec3 c = encoded(linear / std::max({linear.x, linear.y, linear.z, 1e-6f}));
  return ImGui::ColorConvertFloat4ToU32({c.x, c.y, c.z, 1});
}

}  // namespace irad
