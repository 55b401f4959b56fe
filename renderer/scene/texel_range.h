// What the texels of an image hold at least and at most: the bounds of whatever samples it, wherever its coordinates
// lead.
#pragma once

#include "renderer/scene/scene.h"

namespace irad {

/// Linear, 0..1, per channel (alpha is never sRGB). An image without texels: 0 and 1.
struct TexelRange {
  glm::vec4 least{0.0f}, most{1.0f};
};
/// Looks at every texel.
TexelRange texelRange(const SceneImage& image);

}  // namespace irad
