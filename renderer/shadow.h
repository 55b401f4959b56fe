// Shadow maps: sun and spot lights in one 2D depth array, point lights in a cube array. Redrawn only when a light or
// the geometry changes. The lookup (shaders/forward/shadow.glsl) is one function for shading and for the facet gather.
#pragma once

#include "renderer/frame.h"
#include "renderer/gpu_scene.h"

namespace irad {

struct ShadowMaps {
  Image flat;   ///< D32 or R32F, reversed (1 near, 0 far), layers: sun and spot lights; empty where none shines
  Image cubes;  ///< D32, cube array: point lights and wide spots; empty where none shines
  VkSampler flatSampler = VK_NULL_HANDLE;  ///< nearest
  VkSampler cubeSampler = VK_NULL_HANDLE;  ///< compare, linear
};
/// The next two bindings of the pass: shadowFlat and shadowCubes of shaders/forward/shadow.glsl.
Pass& sampleShadows(Pass& pass, const ShadowMaps& maps);

struct ShadowNeeds {
  LightFilter shines = hasIntensity;  ///< lights that get a map
  bool alphaTest = true;              ///< DepthPass::alphaTest
  bool kernels = false;               ///< who rasterizes (renderer/raster.h)
};
/// Draws the map of every light that shines ("RE Shadow") and fills in its layer and matrix; the others' layer is -1.
/// `resolution`: texels per side of a flat map, twice those of a cube's; less where there are too many. DeviceError
/// when the device has not the layers or the memory.
ShadowMaps drawShadows(Context& context, const SceneOnDevice& scene, std::vector<GpuLight>& lights, uint32_t resolution,
                       const ShadowNeeds& needs = {});
/// Of the scene's own lights, which are uploaded again. They and their maps stay when it throws.
ShadowMaps drawShadows(Context& context, SceneOnDevice& scene, uint32_t resolution, const ShadowNeeds& needs = {});
/// Fills in what drawShadows has filled in for the same lights, of which only colours and intensities have changed.
void keepShadows(std::vector<GpuLight>& lights, std::span<const GpuLight> drawn);

/// Types of light that shine.
struct LightKinds {
  bool sun = true, spot = true, point = true;
};
LightKinds kindsOf(std::span<const GpuLight> shining);
/// Sets the constants of shaders/forward/shadow.glsl, which begin at `first`, for a pass that sums up the lights
/// `shining`, none of another kind.
void specialize(Pass& pass, uint32_t first, const LightKinds& kinds, std::span<const GpuLight> shining);

}  // namespace irad
