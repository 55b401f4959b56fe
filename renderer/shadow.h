// Shadow maps: sun and spot lights in one 2D depth array, point lights in a cube array. Redrawn only when a light or the
// geometry changes. The lookup (shaders/forward/shadow.glsl) is one function for shading and for the facet gather.
#pragma once

#include "renderer/frame.h"
#include "renderer/gpu_scene.h"

namespace irad {

struct ShadowMaps {
  Image flat;   ///< D32, reversed (1 near, 0 far), layers: sun and spot lights (at least one layer, so that it can always be bound)
  Image cubes;  ///< D32, cube array: point lights (at least one)
  VkSampler sampler = VK_NULL_HANDLE;  ///< compare, linear
};

/// Draws every light's map ("RE Shadow") and writes layers and matrices into scene.lightValues / scene.lights.
ShadowMaps drawShadows(Context& context, SceneOnDevice& scene, uint32_t resolution);

}  // namespace irad
