// Shadow maps: sun and spot lights in one 2D depth array, point lights in a cube array. Redrawn only when a light or
// the geometry changes. The lookup (shaders/forward/shadow.glsl) is one function for shading and for the facet gather.
#pragma once

#include "renderer/frame.h"
#include "renderer/gpu_scene.h"

namespace irad {

struct ShadowMaps {
  Image flat;   ///< D32, reversed (1 near, 0 far), layers: sun and spot lights (at least one layer, so that it can
                ///< always be bound)
  Image cubes;  ///< D32, cube array: point lights (at least one)
  VkSampler sampler = VK_NULL_HANDLE;  ///< compare, linear
};

/// Draws the map of every light ("RE Shadow") and fills in its layer and matrix. `resolution`: texels per side of a
/// flat map, twice those of a cube's; less where there are too many. DeviceError when the device has not the layers or
/// the memory.
ShadowMaps drawShadows(Context& context, const SceneOnDevice& scene, std::vector<GpuLight>& lights,
                       uint32_t resolution);
/// Of the scene's own lights, which are uploaded again. They and their maps stay when it throws.
ShadowMaps drawShadows(Context& context, SceneOnDevice& scene, uint32_t resolution);

}  // namespace irad
