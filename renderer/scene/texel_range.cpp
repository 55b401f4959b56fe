#include "renderer/scene/texel_range.h"

#include <algorithm>

#include "renderer/scene/srgb.h"

namespace irad {
namespace {

glm::vec4 linear(const std::array<uint8_t, 4>& texel, bool srgb) {
  glm::vec4 out;
  for (int c = 0; c < 4; ++c) out[c] = srgb && c < 3 ? linearFromSrgb(texel[c]) : static_cast<float>(texel[c]) / 255.0f;
  return out;
}

}  // namespace

TexelRange texelRange(const SceneImage& image) {
  if (image.rgba.size() < 4) return {};
  std::array<uint8_t, 4> least{255, 255, 255, 255}, most{};
  for (size_t i = 0; i + 3 < image.rgba.size(); i += 4)
    for (size_t c = 0; c < 4; ++c) {
      least[c] = std::min(least[c], image.rgba[i + c]);
      most[c] = std::max(most[c], image.rgba[i + c]);
    }
  return {linear(least, image.srgb), linear(most, image.srgb)};
}

}  // namespace irad
